#include "research/paper_rule/uv_surface.h"

#include <cmath>
#include <string>

#include "core/base/error.h"

namespace toile::research {

namespace {

/// Tolerance by which a barycentric weight may be negative inside [-]: points on an edge belong to both of
/// its triangles.
constexpr double kEdgeSlack = 1e-9;

double twice_area(const Vec2& a, const Vec2& b, const Vec2& c)
{
    return (b - a).x() * (c - a).y() - (b - a).y() * (c - a).x();
}

std::string text(const Vec2& uv)
{
    return "(" + std::to_string(uv.x()) + ", " + std::to_string(uv.y()) + ")";
}

/// Barycentric weights of the centres of the cuts^2 congruent pieces of a triangle.
std::vector<Vec3> centers_of_pieces(int cuts)
{
    std::vector<Vec3> centers;
    for (int i = 0; i < cuts; ++i)
        for (int j = 0; i + j < cuts; ++j) {
            centers.push_back(Vec3(i + 1.0 / 3, j + 1.0 / 3, cuts - i - j - 2.0 / 3) / cuts);
            if (i + j + 1 < cuts) // the piece that points in the opposite direction
                centers.push_back(Vec3(i + 2.0 / 3, j + 2.0 / 3, cuts - i - j - 4.0 / 3) / cuts);
        }
    return centers;
}

} // namespace

UvSurface::UvSurface(View<const Vec2> uv, View<const Triangle> triangles, int pixels)
    : uv_(uv.begin(), uv.end()), triangles_(triangles.begin(), triangles.end()), area_(uv.size(), 0.0)
{
    if (pixels < 1)
        throw InvalidInput("paper rule: " + std::to_string(pixels) + " pixels; at least 1 needed");
    require_usable();
    Box<2> bounds;
    for (const Vec2& point : uv_)
        bounds.extend(point);
    grid_ = PixelGrid(bounds, pixels);
    for (const Triangle& t : triangles_)
        for (const int vertex : t)
            area_[vertex] += twice_area(uv_[t[0]], uv_[t[1]], uv_[t[2]]) / 6.0;
    for (int k = 0; k < vertex_count(); ++k)
        if (!(area_[k] > 0.0))
            throw InvalidInput("paper rule: vertex " + std::to_string(k) + " belongs to no triangle");
    measure_coverage();
    find_pixels_of_vertices();
    sort_into_pixels();
}

void UvSurface::require_usable() const
{
    if (triangles_.empty())
        throw InvalidInput("paper rule: no triangle");
    for (int k = 0; k < vertex_count(); ++k)
        if (!uv_[k].allFinite())
            throw InvalidInput("paper rule: UV of vertex " + std::to_string(k) + " is " + text(uv_[k]) +
                               "; finite numbers needed");
    for (size_t t = 0; t < triangles_.size(); ++t) {
        const Triangle& corner = triangles_[t];
        if (corner.minCoeff() < 0 || corner.maxCoeff() >= vertex_count())
            throw InvalidInput("paper rule: triangle " + std::to_string(t) +
                               " names a vertex outside of 0.." + std::to_string(vertex_count() - 1));
        if (!(twice_area(uv_[corner[0]], uv_[corner[1]], uv_[corner[2]]) > 0.0))
            throw InvalidInput("paper rule: triangle " + std::to_string(t) +
                               " is flipped or has no area in the UV plane");
    }
}

void UvSurface::measure_coverage()
{
    is_covered_.assign(grid_.count(), 0);
    Triplets integrals;
    for (const Triangle& t : triangles_) {
        Box<2> box;
        for (const int vertex : t)
            box.extend(uv_[vertex]);
        const double pixels_across = box.sizes().cwiseQuotient(grid_.pixel_size).maxCoeff();
        const int cuts = std::max(1, int(std::ceil(2.0 * pixels_across)));
        const double piece = 0.5 * twice_area(uv_[t[0]], uv_[t[1]], uv_[t[2]]) / (double(cuts) * cuts);
        for (const Vec3& weight : centers_of_pieces(cuts)) {
            const Vec2 center = weight[0] * uv_[t[0]] + weight[1] * uv_[t[1]] + weight[2] * uv_[t[2]];
            const int pixel = grid_.index(grid_.pixel_of(center));
            is_covered_[pixel] = 1;
            for (int corner = 0; corner < 3; ++corner)
                integrals.emplace_back(pixel, t[corner], piece * weight[corner]);
        }
    }
    coverage_.resize(grid_.count(), vertex_count());
    coverage_.setFromTriplets(integrals.begin(), integrals.end());
}

void UvSurface::find_pixels_of_vertices()
{
    std::vector<double> largest(vertex_count(), 0.0);
    pixel_of_vertex_.resize(vertex_count());
    for (int pixel = 0; pixel < grid_.count(); ++pixel)
        for (SparseMatrix::InnerIterator entry(coverage_, pixel); entry; ++entry)
            if (const int k = int(entry.col()); entry.value() > largest[k]) {
                largest[k] = entry.value();
                pixel_of_vertex_[k] = grid_.at(pixel);
            }
    for (int k = 0; k < vertex_count(); ++k)
        if (const Pixel nearest = grid_.pixel_of(uv_[k]); is_covered_[grid_.index(nearest)])
            pixel_of_vertex_[k] = nearest;
}

void UvSurface::sort_into_pixels()
{
    triangles_of_pixel_.assign(grid_.count(), {});
    for (size_t t = 0; t < triangles_.size(); ++t) {
        Box<2> box;
        for (const int vertex : triangles_[t])
            box.extend(uv_[vertex]);
        const Pixel first = grid_.pixel_of(box.min()), last = grid_.pixel_of(box.max());
        for (int row = first[1]; row <= last[1]; ++row)
            for (int column = first[0]; column <= last[0]; ++column)
                triangles_of_pixel_[grid_.index({column, row})].push_back(int(t));
    }
}

std::optional<UvSurface::Barycentric> UvSurface::locate(const Vec2& point) const
{
    for (const int t : triangles_of_pixel_[grid_.index(grid_.pixel_of(point))]) {
        const Triangle& corner = triangles_[t];
        const Vec2 &a = uv_[corner[0]], &b = uv_[corner[1]], &c = uv_[corner[2]];
        Vec3 weight(twice_area(point, b, c), twice_area(a, point, c), twice_area(a, b, point));
        weight /= twice_area(a, b, c);
        if (weight.minCoeff() >= -kEdgeSlack) {
            weight = weight.cwiseMax(0.0);
            return Barycentric{corner, weight / weight.sum()};
        }
    }
    return std::nullopt;
}

} // namespace toile::research
