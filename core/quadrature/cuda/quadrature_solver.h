#pragma once

#include <memory>
#include <vector>

#include "core/linear/cuda/solver.h"
#include "core/quadrature/cuda/quadrature.h"
#include "core/quadrature/tables/table_store.h"

namespace toile {

/// QuadratureSolver on a GPU, for one body or several whose H is block-diagonal. Equal bodies share tables
/// and are solved together.
class DeviceQuadratureSolver : public DeviceSolver {
public:
    /// One body.
    struct Part {
        std::vector<EmbeddedPoint> points; ///< of its nodes
        TableListener listener;            ///< called while update() prepares tables
        QuadratureTables::Settings settings = {};
        std::vector<int> rows = {}; ///< of H, ascending; empty: those after the previous part's
    };

    /// Format of the weights: single numbers, or bytes if that is accurate enough (PackingRule).
    enum class Weights { Single, Bytes };

    /// @param space  borrowed
    /// @param store  source of the tables
    DeviceQuadratureSolver(const CudaSpace& space, std::vector<Part> parts,
                           std::shared_ptr<TableStore> store = TableStore::of_process(),
                           Weights weights = Weights::Bytes);

    /// Uses tables that the store has; builds others on the device.
    /// @throws Cancelled if a listener cancels; InvalidInput if H is not positive definite; DeviceError if
    ///         the device has too little memory
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;

    void solve_on_device(View<const Vec3> b, View<Vec3> x) const override;

    DeviceQuadratureSolver* as_quadrature() override { return this; }

    /// The two passes of solve_on_device(): see DeviceQuadrature.
    template <typename Source>
    void begin_solve(const Source& source)
    {
        DeviceQuadrature::begin_solve(operators_, source);
    }
    template <typename Sink>
    void end_solve(const Sink& sink)
    {
        DeviceQuadrature::end_solve(operators_, sink);
    }

private:
    struct Group;
    DeviceQuadrature make_operator(const Group& group) const;

    std::vector<Part> parts_;
    std::shared_ptr<TableStore> store_;
    Weights weights_;
    mutable std::vector<DeviceQuadrature> operators_; ///< per group of equal bodies; a solve writes scratch
};

} // namespace toile
