#pragma once

#include <memory>
#include <vector>

#include "core/linear/device_solver.h"
#include "core/quadrature/device_quadrature.h"
#include "core/quadrature/table_store.h"

namespace toile {

/// QuadratureSolver on a GPU, for one body or several whose H is block-diagonal. Equal bodies share tables
/// and are solved at once.
class DeviceQuadratureSolver : public DeviceSolver {
public:
    /// Rows of H that belong together, in ascending order.
    struct Part {
        std::vector<Place> places; ///< of its nodes
        TableListener listener;    ///< hears of tables that update() prepares
    };

    /// Of the table: as single numbers, or a byte each where that is accurate enough (PackingRule).
    enum class Weights { Single, Bytes };

    /// @param space  borrowed
    /// @param store  where tables come from
    DeviceQuadratureSolver(const CudaSpace& space, std::vector<Part> parts,
                           QuadratureTables::Settings settings = {},
                           std::shared_ptr<TableStore> store = TableStore::of_process(),
                           Weights weights = Weights::Bytes);

    /// Takes tables that the store has at hand; builds others on the device.
    /// @throws Cancelled where a listener wanted no more; InvalidInput where H is not positive definite;
    ///         DeviceError where the device has not the memory
    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;

    void solve_there(View<const Vec3> b, View<Vec3> x) const override;

    /// solve_there() in two halves: see DeviceQuadrature.
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
    QuadratureTables::Settings settings_;
    std::shared_ptr<TableStore> store_;
    Weights weights_;
    mutable std::vector<DeviceQuadrature> operators_; ///< of equal bodies each; a solve writes what they sum
};

} // namespace toile
