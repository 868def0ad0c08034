#pragma once

#include <vector>

#include "core/compute/cuda/mirrored_array.h"
#include "core/compute/cuda/runtime/graph.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/pd/step/point_masses.h"

namespace toile::research {

/// A BaselineMethod on a GPU. A step is one graph with the same kernels every time.
class DeviceBaselineMethod : public PointMasses {
public:
    /// @param space  borrowed
    DeviceBaselineMethod(const CudaSpace& space, const std::vector<Vec3>& positions,
                         std::vector<double> masses);

    /// Records the step.
    void prepare(double dt, const std::vector<unsigned char>& fixed) override;

    /// Makes a step and waits for its end. Same bits in every run.
    /// @return iterations and status; all other members remain 0. If the status is NonFinite, positions and
    ///         velocities are lost.
    /// @throws InvalidInput if contact or a limit is given: these methods have none on a GPU
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets, ActiveSetEnergy* active, StepProjection* projection) override;
    StepReport step(double dt, View<const Vec3> acceleration, const std::vector<unsigned char>& fixed,
                    View<const Vec3> targets)
    {
        return step(dt, acceleration, fixed, targets, nullptr, nullptr);
    }

    View<const Vec3> positions() const override { return x_.host(); }
    View<const Vec3> velocities() const override { return v_.host(); }
    void set_positions(View<const Vec3> x) override { overwrite(x_, x); }
    void set_velocities(View<const Vec3> v) override { overwrite(v_, v); }
    View<const double> masses() const override { return masses_; }

protected:
    /// Fields of the vertices, on the device.
    struct Fields {
        View<Vec3> x, v;               ///< in: at the start of the step; out: at its end [m], [m/s]
        View<const Vec3> acceleration; ///< [m/s^2]
        View<const Vec3> targets;      ///< [m]
        View<const double> mobility;   ///< [1/kg] 0 if fixed
    };

    /// Launches the method while the step is recorded.
    virtual void enqueue(double dt, const Fields& fields) = 0;
    /// Substeps or sweeps per step.
    virtual int iterations() const = 0;

    static void overwrite(MirroredArray<Vec3>& field, View<const Vec3> values);
    const CudaSpace& space() const { return space_; }
    int vertex_count() const { return x_.size(); }

private:
    Fields fields();

    const CudaSpace& space_;
    std::vector<double> masses_; ///< [kg]
    double dt_ = 0.0;
    std::vector<unsigned char> host_fixed_;
    MirroredArray<Vec3> x_, v_, acceleration_, targets_;
    DeviceArray<double> mobility_;
    DeviceArray<int> lost_, lost_sums_; ///< number of vertices that are not finite; scratch
    PinnedArray<int> lost_on_host_;
    CudaGraph step_;
};

} // namespace toile::research
