#include "research/benchmarks/bar.h"

#include <string>

#include "research/paper_rule/kuhn_cut.h"

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
    const auto pieces = kuhn_cut<3>();
    for (int k = 0; k < cells[2]; ++k)
        for (int j = 0; j < cells[1]; ++j)
            for (int i = 0; i < cells[0]; ++i)
                for (const auto& corners : pieces) {
                    volume::Tet& tet = mesh.tets.emplace_back();
                    for (size_t c = 0; c < 4; ++c)
                        tet[c] = number({i + corners[c][0], j + corners[c][1], k + corners[c][2]});
                }
    volume::orient(
        mesh, [](int tet) { return "tetrahedron " + std::to_string(tet); }, "bar");
    return mesh;
}

} // namespace toile::research
