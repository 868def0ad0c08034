#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/linear/direct_solver.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/solve_costs.h"
#include "core/quadrature/tables/background_tables.h"

namespace toile {

/// Global solver that chooses the faster method for this body on this machine and never waits. It begins with
/// the factor. If quadrature promises to be faster, its tables are built in the background. They replace the
/// factor between two steps if they are as fast as promised. Every new H begins again with its factor.
///
/// Building starts once the factor has lost as much time as the tables take to build. Whenever the run ends,
/// it has then cost at most twice the minimum (the ski rental problem [Karlin et al. 1988]). Tables that the
/// store already has cost nothing and are used at once.
///
/// The time of the switch depends on the machine, and so do the last bits of the simulation from there on.
/// Until then the bits are those of DirectSolver.
///
/// Stages count the events: "auto/prepare" every H; "auto/rehearse" costs estimated, and measured again when
/// tables are ready; "auto/search" the store queried for tables; "auto/begin" a build started; "auto/switch"
/// the tables replace the factor; "auto/fail" a failed build, after which the solver keeps the factor.
class AutoSolver : public GlobalSolver {
public:
    using MakePoints = std::function<std::vector<EmbeddedPoint>()>;

    /// Thresholds and cost functions of the choice; tests replace them.
    struct Settings {
        /// Smaller bodies keep the factor at no further cost. They fit in the caches, where the factor is as
        /// fast as tables and a solve takes a tenth of a millisecond.
        int min_vertices = 5000;

        /// Solves with one H before its costs are estimated, which takes as long as about thirty solves. An H
        /// with a shorter life does not repay them.
        long min_solves = 128;

        std::function<SolveCosts(const SupernodalFactor&)> expect = expected_costs;
        std::function<SolveCosts(const SupernodalFactor&, const QuadratureOperator&)> measure =
            measured_costs;
    };

    /// @param points  embedded points of the nodes; called at most once, from another thread
    /// @param store   source of the tables
    /// @param warn    called by begin_step() for failures in the background; may be empty
    explicit AutoSolver(MakePoints points, std::shared_ptr<TableStore> store = TableStore::of_process(),
                        TableCache::Warn warn = nullptr)
        : AutoSolver(std::move(points), std::move(store), std::move(warn), Settings())
    {
    }
    AutoSolver(MakePoints points, std::shared_ptr<TableStore> store, TableCache::Warn warn,
               Settings settings);

    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void begin_step() override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return phase_ != Phase::Quadrature; }

private:
    /// Phases of one H, passed in this order; Direct and Quadrature are final.
    enum class Phase {
        New,    ///< costs not yet known
        Saving, ///< quadrature would be faster, tables not yet worth building
        Building,
        Direct,
        Quadrature
    };

    void find_costs();
    void begin_tables(bool only_stored);
    void take_tables();
    void pass_warnings_on();

    /// Written from the background, read in begin_step().
    struct Warnings {
        std::mutex mutex;
        std::vector<std::string> texts;
    };

    MakePoints points_;
    TableCache::Warn warn_;
    Settings settings_;
    DirectSolver direct_;
    QuadratureOperator quadrature_;
    SparseMatrix H_;                   ///< copy for tables still to be built
    std::vector<unsigned char> fixed_; ///< [n]
    SolveCosts costs_;
    Phase phase_ = Phase::Direct;
    bool has_failed_ = false; ///< building tables failed; not tried again
    mutable long solves_ = 0; ///< solves with the factor of this H
    std::shared_ptr<Warnings> warnings_ = std::make_shared<Warnings>();
    BackgroundTables background_; ///< last: its thread uses the members above
};

} // namespace toile
