#pragma once

#include <vector>

#include "core/compute/cuda/array.h"
#include "core/compute/cuda/runtime/graph.h"
#include "core/pd/cuda/projection.h"
#include "garment/energy/strain_limit/strain_limit.h"

namespace toile::garment {

/// StrainLimit of all cloths of a body on a GPU: the same sweeps, with one kernel per colour.
///
/// A step without violations costs one sum that is read back. A sweep is a graph, one call of stage
/// "garment/strain_limit". The host reads back the number of violating triangles every kSweepsAtOnce sweeps
/// or, while contacts are cleared, after each clearing. Sweeps after the last violation do nothing. Cloths
/// are swept together, up to the largest of their max_sweeps, and are undone one by one.
class DeviceStrainLimit : public DeviceStepProjection {
public:
    /// Sweeps between two readbacks of the number of violating triangles. A larger number waits less often
    /// but launches more idle kernels at the end.
    static constexpr int kSweepsAtOnce = 4;

    explicit DeviceStrainLimit(const CudaSpace& space);

    /// Adds a cloth after the previous ones; all are added before the first step.
    /// @param first_vertex  first vertex of the cloth in the body
    void add(const StrainLimit& limit, int first_vertex);

    bool is_satisfied(View<const Vec3> x) override { return count_violations(x) == 0; }
    void project(View<Vec3> x, View<const double> inverse_masses,
                 const std::function<bool()>& clear_contacts) override;

    /// Computes max_strain() at x.
    void end_step(View<const Vec3> x) override;

    /// Maximum principal stretch of all cloths minus one, including slivers [-], from the last completed
    /// end_step(); 0 before the first.
    double max_strain() const;

private:
    /// Data of the device arrays, for all cloths so far.
    struct OnHost {
        std::vector<Triangle> triangles;
        std::vector<Mat2> rest, rest_inv;
        std::vector<int> kind;
        std::vector<StretchLimits> limits;
        std::vector<double> tolerated;         ///< [cloths] maximum stretch
        std::vector<std::vector<int>> colours; ///< triangles
        std::vector<int> cloth;                ///< [vertices]
        std::vector<int> first_of_chunk{0};    ///< [chunks + 1] triangles; a chunk lies in one cloth
        std::vector<int> first_chunk{0};       ///< [cloths + 1]
    };
    void append(const StrainLimit& limit, int first_vertex);
    void append_chunks(int triangle_count);
    void upload();

    LimitedTriangles triangles() const;
    CountViolating count(View<const Vec3> x);
    int count_violations(View<const Vec3> x);
    int how_many();
    void find_largest(View<const Vec3> x, View<double> of_cloth);
    void record(View<Vec3> x, View<const double> inverse_masses);
    void enqueue_clamp(View<Vec3> x, View<const double> inverse_masses, int colour);
    void sweep(View<const Vec3> x, const std::function<bool()>& clear_contacts);

    const CudaSpace& space_;
    OnHost host_;
    int max_sweeps_ = 0;
    std::vector<int> first_of_colour_{0}; ///< [colours + 1] into order_

    DeviceArray<Triangle> triangles_;
    DeviceArray<Mat2> rest_, rest_inv_;
    DeviceArray<int> kind_;
    DeviceArray<StretchLimits> limits_;
    DeviceArray<double> tolerated_;
    DeviceArray<int> order_; ///< [triangles] colour by colour
    DeviceArray<int> cloth_; ///< [vertices] -1: no cloth
    DeviceArray<int> first_of_chunk_, first_chunk_;

    DeviceArray<unsigned char> violates_;         ///< [triangles]
    DeviceArray<int> violating_, sums_;           ///< [1] number of violating triangles; scratch
    PinnedArray<int> violating_on_host_;          ///< [1]
    DeviceArray<double> stretch_t0_, stretch_t1_; ///< [cloths] maximum, before and after [-]
    PinnedArray<double> stretch_on_host_;         ///< [cloths] stretch_t1_ of the last end_step()
    DeviceArray<double> stretch_of_chunk_;        ///< [chunks]
    DeviceArray<Vec3> kept_;                      ///< [vertices] positions before the first sweep [m]
    View<Vec3> recorded_x_;                       ///< array that the graphs refer to
    View<const double> recorded_masses_;          ///< array that the graphs refer to
    CudaGraph forward_, backward_;
};

} // namespace toile::garment
