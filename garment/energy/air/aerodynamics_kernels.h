#pragma once

#include <cmath>

#include <Eigen/Geometry>

#include "core/compute/types.h"

namespace toile::garment {

/// Air density and drag coefficients; see Aerodynamics.
struct AirSettings {
    double density = 1.2;     ///< [kg/m^3] 0 disables the air
    double normal = 1.0;      ///< [-] drag coefficient of a plate across the flow
    double tangential = 0.05; ///< [-] skin friction along the flow

    /// True if the air can act at all.
    bool is_active() const { return density > 0.0 && (normal > 0.0 || tangential > 0.0); }
};

/// Drag matrix C of a triangle for one corner, a third of the whole: f = C u with magnitudes frozen.
struct DragOfTriangle {
    View<const Vec3> x, v;    ///< [vertices] [m], [m/s]
    View<const Triangle> tri; ///< [triangles] vertex indices
    Vec3 wind;                ///< [m/s]
    View<const Vec3> gusts;   ///< [vertices] deviation from the wind [m/s]; empty in steady wind
    AirSettings settings;
    View<Mat3> drag; ///< [triangles] out [N s/m]

    TOILE_HD void operator()(int t) const
    {
        const Triangle& corner = tri[t];
        const Vec3 doubled_area = (x[corner[1]] - x[corner[0]]).cross(x[corner[2]] - x[corner[0]]);
        const double length = doubled_area.norm();
        if (!(length > 0.0)) {
            drag[t] = Mat3::Zero();
            return;
        }
        const Vec3 n = doubled_area / length;
        Vec3 u = wind - (v[corner[0]] + v[corner[1]] + v[corner[2]]) / 3.0;
        if (gusts.size() > 0)
            u += (gusts[corner[0]] + gusts[corner[1]] + gusts[corner[2]]) / 3.0;
        const Mat3 along = n.lazyProduct(n.transpose());
        const double normal_speed = std::abs(n.dot(u));
        const double tangential_speed = (u - n.dot(u) * n).norm();
        drag[t] = 0.5 * settings.density * (0.5 * length / 3.0) *
                  (settings.normal * normal_speed * along +
                   settings.tangential * tangential_speed * (Mat3::Identity() - along));
    }
};

/// Adds the acceleration of vertex i by the drag of its triangles. The force is reduced if it would
/// accelerate the vertex beyond the air's velocity in the step. |C| bounds the largest eigenvalue.
struct AccelerateByDrag {
    View<const Vec3> v;           ///< [vertices] [m/s]
    View<const double> masses;    ///< [vertices] [kg]
    View<const int> first_corner; ///< [vertices + 1]
    View<const int> corners;      ///< 3 * triangle + corner, ascending per vertex
    View<const Mat3> drag;        ///< [triangles] see DragOfTriangle
    Vec3 wind;                    ///< [m/s]
    View<const Vec3> gusts;       ///< [vertices] [m/s]; empty in steady wind
    double dt;                    ///< [s]
    View<Vec3> acceleration;      ///< [vertices] added to [m/s^2]

    TOILE_HD void operator()(int i) const
    {
        Mat3 C = Mat3::Zero();
        for (int k = first_corner[i]; k < first_corner[i + 1]; ++k)
            C += drag[corners[k] / 3];
        Vec3 u = wind - v[i];
        if (gusts.size() > 0)
            u += gusts[i];
        acceleration[i] += C.lazyProduct(u) / std::fmax(masses[i], dt * C.norm());
    }
};

} // namespace toile::garment
