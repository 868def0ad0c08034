#include "scenes/surfaces/uv_rest.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "core/base/number.h"
#include "garment/energy/principal_stretch.h"
#include "scenes/meshes/cloth_mesh.h"

namespace toile::scenes {

namespace {

/// Ratio of lengths posed and at rest beyond which a triangle is not merely stretched [-]: strain limits of
/// garments are a few per cent.
constexpr double kMaxRatio = 1.15;

double area_of(const TriangleMesh& mesh)
{
    double area = 0.0;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        area += 0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm();
    }
    return area;
}

/// Principal stretches of a triangle from its flat shape to that in the mesh.
Vec2 stretch_of(const FlatTriangle& flat, const TriangleMesh& mesh, const Triangle& t)
{
    Mat2 rest;
    rest << flat[1] - flat[0], flat[2] - flat[0];
    Mat32 now;
    now.col(0) = mesh.positions[t[1]] - mesh.positions[t[0]];
    now.col(1) = mesh.positions[t[2]] - mesh.positions[t[0]];
    return garment::principal_stretch(now * rest.inverse()).sigma;
}

/// Value that a fraction of the items does not exceed.
double quantile(std::vector<double> items, double fraction)
{
    const auto at = items.begin() + std::ptrdiff_t(fraction * double(items.size() - 1));
    std::nth_element(items.begin(), at, items.end());
    return *at;
}

/// Area below which the inverse of a triangle's edges is no number [m^2].
constexpr double kMinArea = 1e-100;

void require_flat_in_range(const UvRest& rest, const std::string& source)
{
    for (const FlatTriangle& triangle : rest.triangles) {
        if (std::abs(signed_area(triangle)) < kMinArea)
            throw InvalidInput(source + ": texture coordinates times \"uv_scale\" " +
                               short_text(rest.uv_scale) +
                               " have no area; give the metres of a texture unit, or leave it out");
        for (const Vec2& corner : triangle) {
            if (is_in_range(Vec3(corner.x(), corner.y(), 0.0)))
                continue;
            char text[200];
            std::snprintf(text, sizeof text,
                          ": texture coordinates times \"uv_scale\" %.6g are at (%.6g, %.6g) m; they must be "
                          "finite and at most 100 km",
                          rest.uv_scale, corner.x(), corner.y());
            throw InvalidInput(source + text);
        }
    }
}

} // namespace

UvRest uv_rest(const scene::Cloth& settings, const ObjMesh& mesh)
{
    UvRest rest;
    rest.triangles = texture_triangles(mesh);
    const TriangleMesh posed = mesh.triangulated();
    double flat_area = 0.0;
    for (const FlatTriangle& triangle : rest.triangles)
        flat_area += std::abs(signed_area(triangle));
    rest.fitting_scale = std::sqrt(area_of(posed) / flat_area) / settings.scale;
    rest.uv_scale = settings.uv_scale.value_or(rest.fitting_scale);
    for (FlatTriangle& triangle : rest.triangles)
        for (Vec2& corner : triangle)
            corner *= rest.uv_scale * settings.scale;
    require_flat_in_range(rest, rest_source_of(settings));

    std::vector<double> smaller, larger;
    for (size_t t = 0; t < rest.triangles.size(); ++t) {
        const Vec2 stretch = stretch_of(rest.triangles[t], posed, posed.triangles[t]);
        larger.push_back(stretch[0]);
        smaller.push_back(stretch[1]);
    }
    rest.stretch_p5 = quantile(std::move(smaller), 0.05);
    rest.stretch_p95 = quantile(std::move(larger), 0.95);
    return rest;
}

std::string scale_note(const UvRest& rest)
{
    char text[120];
    std::snprintf(text, sizeof text, "\"uv_scale\": %.6g makes the areas at rest and of the mesh equal",
                  rest.fitting_scale);
    return text;
}

std::string mismatch_warning(const UvRest& rest)
{
    if (rest.stretch_p5 * kMaxRatio > 1.0 && rest.stretch_p95 < kMaxRatio)
        return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "texture coordinates are no flat copy of the mesh: its triangles are %.3g to %.3g times as "
                  "long as at rest (5 %% to 95 %% of them), and will shrink or grow",
                  rest.stretch_p5, rest.stretch_p95);
    const bool is_fitting = std::abs(std::log(rest.uv_scale / rest.fitting_scale)) < 0.1;
    return is_fitting ? text : text + ("; " + scale_note(rest));
}

} // namespace toile::scenes
