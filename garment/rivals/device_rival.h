#pragma once

#include <vector>

#include "core/backend/cuda/graph.h"
#include "core/backend/cuda/mirrored_array.h"
#include "core/backend/cuda/sum_scratch.h"
#include "core/pd/point_masses.h"

namespace toile {

/// A Rival on a GPU. A step is one graph: its kernels are the same every time.
class DeviceRival : public PointMasses {
public:
    /// @param space  borrowed
    DeviceRival(const CudaSpace& space, const std::vector<Vec3>& positions, std::vector<double> masses);

    /// Records the step.
    void prepare(double dt, const std::vector<unsigned char>& fixed) override;

    /// Waits for the end. Same bits in every run.
    /// @return iterations and status; everything else is left 0. Positions and velocities are lost where it
    /// is
    ///         NonFinite.
    /// @throws InvalidInput where contact or a limit is asked for: these methods know none on a GPU
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
    /// Of the vertices, on the device.
    struct Fields {
        View<Vec3> x, v;               ///< in: at the start of the step; out: at its end [m], [m/s]
        View<const Vec3> acceleration; ///< [m/s^2]
        View<const Vec3> targets;      ///< [m]
        View<const double> mobility;   ///< [1/kg] 0 where fixed
    };

    /// Launches the method itself; recorded.
    virtual void enqueue(double dt, const Fields& fields) = 0;
    /// Of a step: substeps or sweeps.
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
    DeviceArray<int> lost_, lost_sums_; ///< vertices that are nowhere
    PinnedArray<int> lost_on_host_;
    CudaGraph step_;
};

} // namespace toile
