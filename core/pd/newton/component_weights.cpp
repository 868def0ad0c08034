#include "core/pd/newton/component_weights.h"

#include <algorithm>
#include <limits>

#include "core/pd/newton/connected_groups.h"

namespace toile {

ComponentWeights::ComponentWeights(View<const double> masses, const BlockMatrix& blocks,
                                   const SparseMatrix& isotropic)
    : masses_(masses.begin(), masses.end()), component_(masses.size()), weights_(masses.size())
{
    const std::vector<unsigned char> none(masses.size(), 0);
    for (const std::vector<int>& vertices : connected_components(links_of(blocks, isotropic, none), none)) {
        for (const int i : vertices)
            component_[i] = component_count_;
        ++component_count_;
    }
    set_fixed(none);
}

void ComponentWeights::set_fixed(View<const unsigned char> fixed)
{
    if (std::equal(fixed.begin(), fixed.end(), fixed_.begin(), fixed_.end()))
        return;
    fixed_.assign(fixed.begin(), fixed.end());
    std::vector<double> mass_of(component_count_, 0.0);
    for (size_t i = 0; i < masses_.size(); ++i)
        mass_of[component_[i]] += fixed_[i] ? 0.0 : masses_[i];
    mass_ = 0.0;
    double least = std::numeric_limits<double>::infinity();
    int free_count = 0;
    for (const double mass : mass_of) {
        if (mass == 0.0)
            continue;
        ++free_count;
        mass_ += mass;
        least = std::min(least, mass);
    }
    const double mean = mass_ / std::max(free_count, 1);
    lightest_ = free_count > 0 ? least / mean : 1.0;
    for (size_t i = 0; i < masses_.size(); ++i)
        weights_[i] = fixed_[i] ? 0.0 : masses_[i] * (mean / mass_of[component_[i]]);
}

} // namespace toile
