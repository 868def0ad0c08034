#include "research/benchmarks/bar.h"

#include <algorithm>
#include <string>

namespace toile::research {

volume::TetMesh bar_of_tets(const Vec3& size, const std::array<int, 3>& cells)
{
    volume::TetMesh mesh;
    const auto number = [&](const std::array<int, 3>& at) {
        return at[0] + (cells[0] + 1) * (at[1] + (cells[1] + 1) * at[2]);
    };
    for (int k = 0; k <= cells[2]; ++k)
        for (int j = 0; j <= cells[1]; ++j)
            for (int i = 0; i <= cells[0]; ++i)
                mesh.positions.emplace_back(size.x() * i / cells[0], size.y() * j / cells[1],
                                            size.z() * k / cells[2]);
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i) {
                // A path along the axes, in any order, from the first corner to the last one.
                std::array<int, 3> axes{0, 1, 2};
                do {
                    std::array<int, 3> at{i, j, k};
                    volume::Tet tet{number(at)};
                    for (size_t step = 0; step < 3; ++step) {
                        ++at[size_t(axes[step])];
                        tet[step + 1] = number(at);
                    }
                    mesh.tets.push_back(tet);
                } while (std::next_permutation(axes.begin(), axes.end()));
            }
    volume::orient(
        mesh, [](int tet) { return "tetrahedron " + std::to_string(tet); }, "bar");
    return mesh;
}

} // namespace toile::research
