#include "apps/toile/render/pattern.h"

#include <cmath>
#include <numbers>

#include <Eigen/Geometry>

#include "scenes/meshes/rigid_motion.h"

namespace toile::app {

namespace {

using CornerCoordinates = std::vector<std::array<Vec2, 3>>;

double area_of(const std::array<Vec2, 3>& corners)
{
    const Vec2 a = corners[1] - corners[0], b = corners[2] - corners[0];
    return 0.5 * std::abs(a.x() * b.y() - a.y() * b.x());
}

/// Scales texture coordinates, whose unit is arbitrary, so that areas equal the cloth's.
CornerCoordinates in_metres(CornerCoordinates coordinates, const ObjMesh& rest,
                            const std::vector<Triangle>& triangles)
{
    double cloth_area = 0.0, texture_area = 0.0;
    for (size_t k = 0; k < coordinates.size(); ++k) {
        const Triangle& t = triangles[k];
        const Vec3 a = rest.positions[t[1]] - rest.positions[t[0]];
        cloth_area += 0.5 * a.cross(rest.positions[t[2]] - rest.positions[t[0]]).norm();
        texture_area += area_of(coordinates[k]);
    }
    const double scale = texture_area > 0.0 ? std::sqrt(cloth_area / texture_area) : 1.0;
    for (std::array<Vec2, 3>& corners : coordinates)
        for (Vec2& corner : corners)
            corner *= scale;
    return coordinates;
}

/// Arc length and height around the Y axis. Triangles across the seam at angle pi are unwrapped.
std::array<Vec2, 3> around_axis(const std::array<Vec3, 3>& corners, double radius)
{
    std::array<Vec2, 3> coordinates;
    const double first = std::atan2(corners[0].x(), corners[0].z());
    for (size_t k = 0; k < 3; ++k) {
        const double angle = std::atan2(corners[k].x(), corners[k].z());
        const double from_first = std::remainder(angle - first, 2.0 * std::numbers::pi);
        coordinates[k] = Vec2(radius * (first + from_first), corners[k].y());
    }
    return coordinates;
}

/// Coordinates of a generated cloth, in the frame of its cut.
CornerCoordinates of_cut(const scene::Cloth& cloth, const ObjMesh& rest,
                         const std::vector<Triangle>& triangles)
{
    const Mat3 R = scenes::rotation_of(cloth.rotate_deg);
    const auto* skirt = std::get_if<scene::Skirt>(&cloth.shape);
    CornerCoordinates coordinates;
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

Vec3 linear_color(const Vec3& srgb)
{
    return srgb.unaryExpr(
        [](double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); });
}

void apply_pattern(const scene::Cloth& cloth, const ObjMesh& rest, const std::vector<Triangle>& triangles,
                   preview::RenderMesh& mesh)
{
    if (cloth.pattern == scene::PreviewPattern::Plain)
        return;
    CornerCoordinates coordinates;
    if (std::holds_alternative<std::filesystem::path>(cloth.shape))
        coordinates = in_metres(preview::corner_coordinates(rest), rest, triangles);
    else
        coordinates = of_cut(cloth, rest, triangles);
    if (coordinates.size() != triangles.size())
        return;
    mesh.corner_coordinates = std::move(coordinates);
    mesh.material.pattern = cloth.pattern == scene::PreviewPattern::Checker ? preview::Pattern::Checker
                                                                            : preview::Pattern::Stripes;
    mesh.material.pattern_front = linear_color(Vec3(0.93, 0.91, 0.87));
}

} // namespace toile::app
