#include "tests/volume/blocks.h"

#include <algorithm>
#include <random>

namespace toile::test {

bool Block::is_on_surface(int vertex) const
{
    const std::array<int, 3> index{vertex % (cells[0] + 1), vertex / (cells[0] + 1) % (cells[1] + 1),
                                   vertex / (cells[0] + 1) / (cells[1] + 1)};
    for (int a = 0; a < 3; ++a)
        if (index[a] == 0 || index[a] == cells[a])
            return true;
    return false;
}

Block make_block(const Vec3& size, const std::array<int, 3>& cells, double disorder)
{
    Block block{size, cells, {}};
    std::mt19937 random(7);
    std::uniform_real_distribution<double> offset(-disorder, disorder);
    for (int k = 0; k <= cells[2]; ++k)
        for (int j = 0; j <= cells[1]; ++j)
            for (int i = 0; i <= cells[0]; ++i) {
                Vec3 x(i, j, k);
                if (!block.is_on_surface(block.at(i, j, k)))
                    x += Vec3(offset(random), offset(random), offset(random));
                for (int a = 0; a < 3; ++a)
                    x[a] *= size[a] / cells[a];
                block.mesh.positions.push_back(x);
            }
    // Paths along the axes, in each of their orders, from the corner with even indices to the opposite one.
    std::array<int, 3> axes{0, 1, 2};
    do
        for (int k = 0; k < cells[2]; ++k)
            for (int j = 0; j < cells[1]; ++j)
                for (int i = 0; i < cells[0]; ++i) {
                    std::array<int, 3> corner{i + i % 2, j + j % 2, k + k % 2};
                    const std::array<int, 3> opposite{i + 1 - i % 2, j + 1 - j % 2, k + 1 - k % 2};
                    volume::Tet tet{block.at(corner[0], corner[1], corner[2])};
                    for (int step = 0; step < 3; ++step) {
                        corner[axes[step]] = opposite[axes[step]];
                        tet[step + 1] = block.at(corner[0], corner[1], corner[2]);
                    }
                    block.mesh.tets.push_back(tet);
                }
    while (std::next_permutation(axes.begin(), axes.end()));
    volume::orient(
        block.mesh, [](int t) { return "tetrahedron " + std::to_string(t); }, "block");
    return block;
}

} // namespace toile::test
