#include "garment/energy/aerodynamics.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Drag matrix of one triangle: C with f = C u, magnitudes frozen.
struct TriangleDrag {
    View<const Vec3> x;
    View<const Vec3> v;
    View<const Triangle> tri;
    Vec3 wind;
    View<const Vec3> gusts; // empty in steady wind
    Aerodynamics::Settings settings;
    View<Mat3> drag;

    void operator()(int t) const
    {
        const Triangle& corner = tri[t];
        const Vec3 doubled_area = (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]);
        const double length = doubled_area.norm();
        drag[t].setZero();
        if (!(length > 0.0))
            return;
        const Vec3 n = doubled_area / length;
        Vec3 u = wind - (v[corner[0]] + v[corner[1]] + v[corner[2]]) / 3.0;
        if (gusts.size() > 0)
            u += (gusts[corner[0]] + gusts[corner[1]] + gusts[corner[2]]) / 3.0;
        const Mat3 along = n * n.transpose();
        const double normal_speed = std::abs(n.dot(u));
        const double tangential_speed = (u - n.dot(u) * n).norm();
        drag[t] = 0.5 * settings.density * (0.5 * length / 3.0) *
                  (settings.normal * normal_speed * along +
                   settings.tangential * tangential_speed * (Mat3::Identity() - along));
    }
};

} // namespace

Aerodynamics::Aerodynamics(std::shared_ptr<const RestShape> rest, const Settings& settings)
    : rest_(std::move(rest)), settings_(settings), drag_(rest_->triangles.size())
{
}

void Aerodynamics::add_acceleration(View<const Vec3> x, View<const Vec3> v, View<const double> masses,
                                    const Vec3& wind, double dt, View<Vec3> acceleration,
                                    View<const Vec3> gusts)
{
    const StageScope stage("garment/aerodynamics");
    parallel_for(kCpu, "aerodynamics/triangles", int(drag_.size()),
                 TriangleDrag{x, v, rest_->triangles, wind, gusts, settings_, drag_});
    const Incidence& corners = rest_->topology.corners_of_vertex;
    parallel_for(kCpu, "aerodynamics/vertices", x.size(), [&](int i) {
        Mat3 C = Mat3::Zero();
        for (const int corner : corners.of(i))
            C += drag_[corner / 3];
        Vec3 u = wind - v[i];
        if (gusts.size() > 0)
            u += gusts[i];

        // The whole force, unless it would blow the vertex past the air: |C| bounds the largest eigenvalue.
        acceleration[i] += C * u / std::max(masses[i], dt * C.norm());
    });
}

} // namespace toile
