#include "apps/toile/render/print.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "avatars/model/appearance.h"
#include "core/mesh/obj.h"
#include "scenes/meshes/rigid_motion.h"

namespace toile::app {

namespace {

/// Texture coordinates, whose unit is arbitrary, scaled so that areas equal the cloth's.
std::vector<FlatTriangle> texture_in_metres(const ObjMesh& rest, const std::vector<Triangle>& triangles)
{
    std::vector<FlatTriangle> texture = texture_triangles(rest);
    double cloth_area = 0.0, texture_area = 0.0;
    for (size_t k = 0; k < texture.size(); ++k) {
        const Triangle& t = triangles[k];
        const Vec3 a = rest.positions[t[1]] - rest.positions[t[0]];
        cloth_area += 0.5 * a.cross(rest.positions[t[2]] - rest.positions[t[0]]).norm();
        texture_area += std::abs(signed_area(texture[k]));
    }
    const double scale = texture_area > 0.0 ? std::sqrt(cloth_area / texture_area) : 1.0;
    for (FlatTriangle& corners : texture)
        for (Vec2& corner : corners)
            corner *= scale;
    return texture;
}

/// Arc length and height around the Y axis. Triangles across the seam at angle pi are unwrapped.
FlatTriangle around_axis(const std::array<Vec3, 3>& corners, double radius)
{
    FlatTriangle coordinates;
    const double first = std::atan2(corners[0].x(), corners[0].z());
    for (size_t k = 0; k < 3; ++k) {
        const double angle = std::atan2(corners[k].x(), corners[k].z());
        const double from_first = std::remainder(angle - first, 2.0 * std::numbers::pi);
        coordinates[k] = Vec2(radius * (first + from_first), corners[k].y());
    }
    return coordinates;
}

/// Coordinates of a generated cloth, in the frame of its cut.
std::vector<FlatTriangle> of_cut(const scene::Cloth& cloth, const ObjMesh& rest,
                                 const std::vector<Triangle>& triangles)
{
    const Mat3 R = scenes::rotation_of(cloth.rotate_deg);
    const auto* skirt = std::get_if<scene::Skirt>(&cloth.shape);
    std::vector<FlatTriangle> coordinates;
    for (const Triangle& t : triangles) {
        std::array<Vec3, 3> corners;
        for (int k = 0; k < 3; ++k)
            corners[size_t(k)] = R.transpose() * (rest.positions[t[k]] - cloth.translate);
        if (skirt != nullptr)
            coordinates.push_back(around_axis(corners, skirt->hem_radius * cloth.scale));
        else
            coordinates.push_back({Vec2(corners[0].x(), corners[0].z()), Vec2(corners[1].x(), corners[1].z()),
                                   Vec2(corners[2].x(), corners[2].z())});
    }
    return coordinates;
}

} // namespace

Vec3 linear_color(const Vec3& srgb) { return srgb.unaryExpr(&avatars::linear_from_srgb); }

void apply_print(const scene::Cloth& cloth, const scenes::ClothState& state, preview::RenderMesh& mesh)
{
    if (cloth.print == scene::Print::Plain)
        return;
    std::vector<FlatTriangle> coordinates;
    const bool is_gathered = cloth.rest_file && !state.rest.polygon_uvs.empty();
    if (!state.panels.empty() && !is_gathered) // gathers compress what is printed on the flat cloth
        coordinates = state.panels;
    else if (std::holds_alternative<std::filesystem::path>(cloth.shape))
        coordinates = texture_in_metres(state.rest, state.triangles);
    else
        coordinates = of_cut(cloth, state.rest, state.triangles);
    if (coordinates.size() != state.triangles.size())
        return;
    mesh.corner_coordinates = std::move(coordinates);
    mesh.material.print =
        cloth.print == scene::Print::Checker ? preview::Print::Checker : preview::Print::Stripes;
    mesh.material.print_front = linear_color(Vec3(0.93, 0.91, 0.87));
}

} // namespace toile::app
