#include "garment/pattern/mesh/material_coordinates.h"

#include <numbers>

namespace toile::garment {

bool shrinks(const Panel& panel) { return panel.shrink_warp != 1.0 || panel.shrink_weft != 1.0; }

std::vector<Vec2> material_coordinates(const Pattern& pattern, const PatternMesh& mesh)
{
    std::vector<Vec2> material = mesh.uv;
    for (size_t p = 0; p < pattern.panels.size(); ++p) {
        const Panel& panel = pattern.panels[p];
        if (panel.grain_deg == 0.0 && !shrinks(panel))
            continue;
        const Mat2 upright = Eigen::Rotation2Dd(-panel.grain_deg * std::numbers::pi / 180.0).matrix();
        const Mat2 material_from_panel = Vec2(panel.shrink_weft, panel.shrink_warp).asDiagonal() * upright;
        for (int v = mesh.first_vertex[p]; v < mesh.first_vertex[p + 1]; ++v)
            material[size_t(v)] = material_from_panel * mesh.uv[size_t(v)];
    }
    return material;
}

} // namespace toile::garment
