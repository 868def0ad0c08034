#include "scenes/surfaces/uv_rest.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

#include "core/base/error.h"
#include "scenes/meshes/cloth_mesh.h"

namespace toile::scenes {

namespace {

/// Ratio of areas of a triangle posed and at rest beyond which it is not merely stretched [-]: strain limits
/// of garments are a few per cent.
constexpr double kMaxAreaRatio = 1.3;

std::vector<double> areas_of(const TriangleMesh& mesh)
{
    std::vector<double> areas;
    for (const Triangle& t : mesh.triangles) {
        const Vec3& a = mesh.positions[t[0]];
        areas.push_back(0.5 * (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).norm());
    }
    return areas;
}

double sum_of(const std::vector<double>& values)
{
    double sum = 0.0;
    for (const double value : values)
        sum += value;
    return sum;
}

/// Value that a fraction of the items does not exceed.
double quantile(std::vector<double> items, double fraction)
{
    const auto at = items.begin() + std::ptrdiff_t(fraction * double(items.size() - 1));
    std::nth_element(items.begin(), at, items.end());
    return *at;
}

void require_flat_in_range(const UvRest& rest, const std::string& source)
{
    for (const FlatTriangle& triangle : rest.triangles)
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

} // namespace

UvRest uv_rest(const scene::Cloth& settings, const ObjMesh& mesh)
{
    UvRest rest;
    rest.triangles = texture_triangles(mesh);
    const std::vector<double> posed = areas_of(mesh.triangulated());
    std::vector<double> ratios;
    for (const FlatTriangle& triangle : rest.triangles)
        ratios.push_back(std::abs(signed_area(triangle)));
    rest.fitting_scale = std::sqrt(sum_of(posed) / sum_of(ratios)) / settings.scale;
    rest.uv_scale = settings.uv_scale.value_or(rest.fitting_scale);

    const double factor = rest.uv_scale * settings.scale;
    for (FlatTriangle& triangle : rest.triangles)
        for (Vec2& corner : triangle)
            corner *= factor;
    require_flat_in_range(rest, source_of(settings));
    for (size_t t = 0; t < ratios.size(); ++t)
        ratios[t] = posed[t] / (factor * factor * ratios[t]);
    rest.ratio_p5 = quantile(ratios, 0.05);
    rest.ratio_p95 = quantile(ratios, 0.95);
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
    if (rest.ratio_p5 * kMaxAreaRatio > 1.0 && rest.ratio_p95 < kMaxAreaRatio)
        return {};
    char text[200];
    std::snprintf(text, sizeof text,
                  "texture coordinates are no flat copy of the mesh: its triangles have %.3g to %.3g times "
                  "their area at rest (5 %% to 95 %% of them), and will shrink or grow",
                  rest.ratio_p5, rest.ratio_p95);
    const bool is_fitting = std::abs(std::log(rest.uv_scale / rest.fitting_scale)) < 0.1;
    return is_fitting ? text : text + ("; " + scale_note(rest));
}

} // namespace toile::scenes
