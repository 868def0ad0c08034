#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "core/linear/direct_solver.h"
#include "core/quadrature/background_tables.h"
#include "core/quadrature/quadrature_operator.h"
#include "core/quadrature/solve_costs.h"

namespace toile {

/// The global solver that is faster for this body on this machine, without ever waiting: it begins with the
/// factor; where quadrature promises to be faster, its tables are built in the background and taken between
/// two steps, if they are as fast as promised. Every new H begins anew with its factor.
///
/// Tables are begun once the factor has lost as much time as building them takes: whenever the run then ends,
/// it has cost at most twice the least possible (the ski rental problem [Karlin et al. 1988]). Tables that
/// the store has at hand cost nothing and are taken at once.
///
/// When it switches depends on the machine, and so do the last bits of what is simulated from there on; until
/// it switches they are the DirectSolver's.
///
/// Stages count what happens: "auto/prepare" every H; "auto/rehearse" costs found, before and again when
/// tables are ready; "auto/look" the store asked for tables at hand; "auto/begin" tables begun; "auto/switch"
/// tables taken; "auto/fail" tables that could not be made, after which it stays with the factor.
class AutoSolver : public GlobalSolver {
public:
    using MakePlaces = std::function<std::vector<Place>()>;

    /// What decides. Replaceable, so that tests decide.
    struct Settings {
        /// Smaller bodies stay with the factor, and cost nothing more: they stay in the caches, where it is
        /// as fast as tables, and a solve takes a tenth of a millisecond.
        int least_vertices = 5000;

        /// Solves with one H before its costs are found, which takes as long as some thirty: an H that does
        /// not live longer is not worth them.
        long least_solves = 128;

        std::function<SolveCosts(const SupernodalFactor&)> expect = expected_costs;
        std::function<SolveCosts(const SupernodalFactor&, const QuadratureOperator&)> measure =
            measured_costs;
    };

    /// @param places  where the nodes are; called at most once, from another thread
    /// @param store   where tables come from
    /// @param warn    hears of what went wrong in the background, in begin_step(); may be empty
    explicit AutoSolver(MakePlaces places, std::shared_ptr<TableStore> store = TableStore::of_process(),
                        TableCache::Warn warn = nullptr)
        : AutoSolver(std::move(places), std::move(store), std::move(warn), Settings())
    {
    }
    AutoSolver(MakePlaces places, std::shared_ptr<TableStore> store, TableCache::Warn warn,
               Settings settings);

    void update(const SparseMatrix& H, View<const unsigned char> fixed) override;
    void begin_step() override;
    void solve(View<const Vec3> b, View<Vec3> x) const override;
    bool is_symmetric() const override { return phase_ != Phase::Quadrature; }

private:
    /// Of one H, passed in this order; Direct and Quadrature last.
    enum class Phase {
        New,    ///< costs not yet known
        Saving, ///< quadrature would be faster, tables not yet worth building
        Building,
        Direct,
        Quadrature
    };

    void find_costs();
    void begin_tables(bool only_at_hand);
    void take_tables();
    void pass_warnings_on();

    /// Written from the background, read in begin_step().
    struct Warnings {
        std::mutex mutex;
        std::vector<std::string> texts;
    };

    MakePlaces places_;
    TableCache::Warn warn_;
    Settings settings_;
    DirectSolver direct_;
    QuadratureOperator quadrature_;
    SparseMatrix H_;                   ///< as given, for tables yet to come
    std::vector<unsigned char> fixed_; ///< [n]
    SolveCosts costs_;
    Phase phase_ = Phase::Direct;
    bool has_failed_ = false; ///< to build tables: never tried again
    mutable long solves_ = 0; ///< with the factor of this H
    std::shared_ptr<Warnings> warnings_ = std::make_shared<Warnings>();
    BackgroundTables background_; ///< last: its thread uses the above
};

} // namespace toile
