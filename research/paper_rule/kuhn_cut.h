#pragma once

#include <algorithm>
#include <array>
#include <numeric>
#include <vector>

namespace toile::research {

/// Kuhn's cut of the unit cube into Dim! simplices of the same volume: the corners of each are a path along
/// the axes, in one of their orders, from the corner at 0 to the opposite one. Half of them are inside out.
/// @return [orders of the axes][corners of a simplex] coordinates, 0 or 1
template <int Dim>
std::vector<std::array<std::array<int, Dim>, Dim + 1>> kuhn_cut()
{
    std::vector<std::array<std::array<int, Dim>, Dim + 1>> simplices;
    std::array<int, Dim> axes;
    std::iota(axes.begin(), axes.end(), 0);
    do {
        auto& corners = simplices.emplace_back();
        corners[0].fill(0);
        for (size_t step = 0; step < Dim; ++step) {
            corners[step + 1] = corners[step];
            corners[step + 1][size_t(axes[step])] = 1;
        }
    } while (std::next_permutation(axes.begin(), axes.end()));
    return simplices;
}

} // namespace toile::research
