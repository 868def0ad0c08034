#include "core/quadrature/auto_solver.h"

#include <utility>

#include "core/compute/parallel.h"

namespace toile {

namespace {

/// Threads that build the tables of one body.
constexpr int kThreads = 1;

/// Wrapper that calls `make` once. For one thread at a time.
AutoSolver::MakePoints made_once(AutoSolver::MakePoints make)
{
    return [make = std::move(make), points = std::make_shared<std::vector<EmbeddedPoint>>()] {
        if (points->empty())
            *points = make();
        return *points;
    };
}

} // namespace

AutoSolver::AutoSolver(MakePoints points, std::shared_ptr<TableStore> store, TableCache::Warn warn,
                       Settings settings)
    : points_(made_once(std::move(points))), warn_(std::move(warn)), settings_(std::move(settings)),
      background_(std::move(store), kThreads, [warnings = warnings_](const std::string& text) {
          const std::lock_guard lock(warnings->mutex);
          warnings->texts.push_back(text);
      })
{
}

void AutoSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    const StageScope stage("auto/prepare");
    background_.cancel();
    quadrature_ = QuadratureOperator();
    phase_ = Phase::Direct;
    direct_.update(H, fixed);
    solves_ = 0;

    // Tables are built beside the simulation, which needs a second thread.
    if (has_failed_ || fixed.size() < settings_.min_vertices || thread_count(kCpu) < 2)
        return;
    H_ = H;
    fixed_.assign(fixed.begin(), fixed.end());
    phase_ = Phase::New;
}

void AutoSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    if (phase_ == Phase::Quadrature) {
        quadrature_.solve(b, x);
    } else {
        ++solves_;
        direct_.solve(b, x);
    }
}

void AutoSolver::begin_step()
{
    pass_warnings_on();
    if (phase_ == Phase::New && solves_ >= settings_.min_solves)
        find_costs();
    if (phase_ == Phase::Saving || phase_ == Phase::Building)
        take_tables();
    if (phase_ == Phase::Saving && double(solves_) * costs_.loss() >= costs_.build) {
        const StageScope stage("auto/begin");
        phase_ = Phase::Building;
        begin_tables(false);
    }
}

void AutoSolver::find_costs()
{
    const StageScope stage("auto/rehearse");
    costs_ = settings_.expect(*direct_.factor());
    phase_ = costs_.pays() ? Phase::Saving : Phase::Direct;
    if (phase_ == Phase::Saving) {
        const StageScope search("auto/search");
        begin_tables(true);
    }
}

void AutoSolver::begin_tables(bool only_stored)
{
    background_.start({H_, fixed_, points_, {}, only_stored, direct_.factor()});
}

/// Takes tables that are ready, if any. They are timed first: if they are not faster than the factor now,
/// they are dropped for this H.
void AutoSolver::take_tables()
try {
    std::shared_ptr<const QuadratureTables> tables = background_.take_if_ready();
    if (!tables)
        return;
    quadrature_ = QuadratureOperator(std::move(tables));
    {
        const StageScope stage("auto/rehearse");
        phase_ = settings_.measure(*direct_.factor(), quadrature_).pays() ? Phase::Quadrature : Phase::Direct;
    }
    if (phase_ == Phase::Quadrature) {
        const StageScope stage("auto/switch");
    } else {
        quadrature_ = QuadratureOperator();
    }
} catch (const std::exception& error) {
    const StageScope stage("auto/fail");
    phase_ = Phase::Direct;
    has_failed_ = true;
    background_.cancel();
    if (warn_)
        warn_(std::string("quadrature tables could not be made: ") + error.what() +
              "; the direct solver goes on alone");
}

void AutoSolver::pass_warnings_on()
{
    std::vector<std::string> texts;
    {
        const std::lock_guard lock(warnings_->mutex);
        texts.swap(warnings_->texts);
    }
    if (warn_)
        for (const std::string& text : texts)
            warn_(text);
}

} // namespace toile
