#include "garment/pattern/mesh/material_coordinates.h"

#include <numbers>

namespace toile::garment {

std::vector<Vec2> material_coordinates(const Pattern& pattern, const PatternMesh& mesh)
{
    std::vector<Vec2> material = mesh.uv;
    for (size_t p = 0; p < pattern.panels.size(); ++p) {
        const Panel& panel = pattern.panels[p];
        if (panel.grain_deg == 0.0)
            continue;
        const Mat2 upright = Eigen::Rotation2Dd(-panel.grain_deg * std::numbers::pi / 180.0).matrix();
        for (int v = mesh.first_vertex[p]; v < mesh.first_vertex[p + 1]; ++v)
            material[size_t(v)] = upright * mesh.uv[size_t(v)];
    }
    return material;
}

} // namespace toile::garment
