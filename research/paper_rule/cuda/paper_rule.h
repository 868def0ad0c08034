#pragma once

#include "core/compute/cuda/array.h"
#include "core/linear/cuda/solver.h"
#include "research/paper_rule/paper_rule.h"

namespace toile::research {

/// PaperRule on a GPU: its table comes from the CPU; its sums are in double precision, by a team of threads
/// per vertex. The first application is one kernel, each further one two.
class DevicePaperRule final : public DeviceSolver {
public:
    using Settings = PaperRule::Settings;

    /// @param space  borrowed; the others as for PaperRule
    DevicePaperRule(const CudaSpace& space, View<const Vec2> uv, View<const Triangle> triangles,
                    const Settings& settings = {});

    /// Updates as PaperRule::update().
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void solve_on_device(View<const Vec3> b, View<Vec3> x) const override;

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
    mutable DeviceArray<Vec3> left_; ///< residual of b between applications
};

} // namespace toile::research
