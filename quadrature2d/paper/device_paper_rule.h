#pragma once

#include "core/backend/cuda/array.h"
#include "core/linear/device_solver.h"
#include "quadrature2d/paper/paper_rule.h"

namespace toile {

/// PaperRule on a GPU: the table that it makes on the CPU, and its sums in double precision, by a team of
/// threads a vertex. An application is one kernel, each further one two.
class DevicePaperRule final : public DeviceSolver {
public:
    using Settings = PaperRule::Settings;

    /// @param space  borrowed; otherwise as PaperRule
    DevicePaperRule(const CudaSpace& space, View<const Vec2> uv, View<const Triangle> triangles,
                    const Settings& settings = {});

    /// As PaperRule::update().
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve_there(View<const Vec3> b, View<Vec3> x) const override;

private:
    /// WeightedRows on the device.
    struct Rows {
        DeviceArray<int> first;
        DeviceArray<WeightedVertex> entries;

        explicit Rows(const CudaSpace& space)
            : first(space, "paper_rule/first"), entries(space, "paper_rule/entries")
        {
        }
        void upload(const WeightedRows& rows);
        WeightedRows view() const { return {first.view(), entries.view()}; }
    };

    PaperRule on_cpu_;
    Rows rule_, H_;
    mutable DeviceArray<Vec3> left_; ///< of b, between applications
};

} // namespace toile
