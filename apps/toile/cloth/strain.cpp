#include "apps/toile/cloth/strain.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace toile::app {

namespace {

/// Larger singular value of a 3 x 2 matrix with columns a and b:
///   sigma^2 = (|a|^2 + |b|^2)/2 + sqrt(((|a|^2 - |b|^2)/2)^2 + (a.b)^2)
double largest_singular_value(const Vec3& a, const Vec3& b)
{
    const double aa = a.squaredNorm(), bb = b.squaredNorm(), ab = a.dot(b);
    return std::sqrt(0.5 * (aa + bb) + std::hypot(0.5 * (aa - bb), ab));
}

} // namespace

StrainMeter::StrainMeter(View<const Vec3> rest, std::vector<Triangle> triangles)
    : triangles_(std::move(triangles))
{
    for (const Triangle& t : triangles_)
        add(rest[t[1]] - rest[t[0]], rest[t[2]] - rest[t[0]]);
}

StrainMeter::StrainMeter(const std::vector<FlatTriangle>& panels, std::vector<Triangle> triangles)
    : triangles_(std::move(triangles))
{
    for (const FlatTriangle& corner : panels) {
        const Vec2 e1 = corner[1] - corner[0], e2 = corner[2] - corner[0];
        add(Vec3(e1.x(), e1.y(), 0.0), Vec3(e2.x(), e2.y(), 0.0));
    }
}

/// Appends a triangle by two edges at rest, expressed in its plane, the first along u.
void StrainMeter::add(const Vec3& e1, const Vec3& e2)
{
    const Vec3 u = e1.normalized();
    const double along = e2.dot(u);
    Mat2 edges;
    edges << e1.norm(), along, 0.0, (e2 - along * u).norm();
    inverse_rest_.push_back(edges.inverse());
    rest_area_ += 0.5 * edges.determinant();
}

double StrainMeter::rest_area(int triangle) const
{
    return 0.5 / inverse_rest_[size_t(triangle)].determinant();
}

StrainMeter::Stretches StrainMeter::stretches(View<const Vec3> x, int triangle) const
{
    // Deformation gradient F = (a, b): rest edges to current edges. Its singular values have the product
    // |a x b|, which does not cancel as the difference in the formula of the larger would.
    const Triangle& t = triangles_[size_t(triangle)];
    const Vec3 e1 = x[t[1]] - x[t[0]], e2 = x[t[2]] - x[t[0]];
    const Mat2& inverse = inverse_rest_[size_t(triangle)];
    const Vec3 a = inverse(0, 0) * e1 + inverse(1, 0) * e2, b = inverse(0, 1) * e1 + inverse(1, 1) * e2;
    const double larger = largest_singular_value(a, b);
    return {larger, larger > 0.0 ? a.cross(b).norm() / larger : 0.0};
}

StrainMeter::Largest StrainMeter::largest(View<const Vec3> x, View<const unsigned char> attached) const
{
    Largest largest;
    for (int k = 0; k < triangle_count(); ++k) {
        const Triangle& t = triangles_[size_t(k)];
        const double strain = stretches(x, k).larger - 1.0;
        const bool is_attached = attached[t[0]] != 0 && attached[t[1]] != 0 && attached[t[2]] != 0;
        if (is_attached) {
            largest.of_attached = std::fmax(largest.of_attached, strain);
        } else if (strain > largest.of_free) {
            largest.of_free = strain;
            largest.free_triangle = k;
        }
    }
    return largest;
}

} // namespace toile::app
