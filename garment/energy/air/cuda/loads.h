#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/acceleration.h"
#include "garment/energy/air/gusts.h"
#include "garment/energy/air/loads_kernels.h"
#include "garment/energy/rest_shape.h"

namespace toile::garment {

/// Gravity, damping and air with gusts on all cloths of a body on a GPU: the counterpart of Aerodynamics and
/// Gusts on the CPU, with the same kernels.
class DeviceLoads : public DeviceAcceleration {
public:
    struct Settings {
        Vec3 gravity = Vec3(0.0, -9.81, 0.0); ///< [m/s^2]
        AirSettings air;
        Vec3 wind = Vec3::Zero(); ///< mean velocity of the air [m/s]
    };

    /// @param gusts  deviations from the mean wind
    DeviceLoads(const CudaSpace& space, const Settings& settings, const Gusts& gusts);

    /// Adds a cloth after the previous ones and before vertices without air; all are added before the first
    /// step.
    /// @param masses        [vertices] of the cloth [kg]
    /// @param damping       of its fabric [1/s]
    /// @param first_vertex  first vertex of the cloth in the body
    void add(const RestShape& rest, View<const double> masses, double damping, int first_vertex);

    /// Adds vertices that gravity and damping move, but no air.
    /// @param vertices  in the body
    /// @param damping   [1/s]
    void add_without_air(View<const int> vertices, double damping);

    /// Sets the end [s] of the coming step, on which gusts depend, and whether there are loads in it at all.
    void set_step(double t_t1, bool is_loaded)
    {
        t_t1_ = t_t1;
        is_loaded_ = is_loaded;
    }

    /// Stages "loads/gusts" and "loads/drag" if there are gusts and air, and "loads/vertices".
    void accelerate(double dt, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration) override;

private:
    /// Data of the device arrays, for all cloths so far.
    struct OnHost {
        std::vector<Triangle> triangles;
        std::vector<int> cloth, first_corner{0}, corners;
        std::vector<double> masses, damping;
    };
    void resize(int vertex_count);
    void upload();

    const CudaSpace& space_;
    Settings settings_;
    double t_t1_ = 0.0;
    bool is_loaded_ = true;
    OnHost host_;
    DeviceArray<GustMode> modes_;
    DeviceArray<Triangle> triangles_;
    DeviceArray<int> cloth_, first_corner_, corners_;
    DeviceArray<double> masses_, damping_; ///< [vertices], [cloths]
    DeviceArray<Mat3> drag_;               ///< [triangles] see DragOfTriangle
    DeviceArray<Vec3> gusts_;              ///< [vertices] [m/s]; empty in steady wind
};

} // namespace toile::garment
