#include "collision/self/kept_pairs.h"

#include <algorithm>
#include <limits>

#include "collision/self/pair_geometry.h"
#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Reach of a list, relative to the mean edge and to the margin [-]; the smaller applies. A larger reach
/// serves more searches. But from a third of an edge on, neighbours in the same cloth are pairs too. In a
/// stack, every layer pairs with as many others as the reach contains margins.
constexpr double kReachOfEdge = 0.25, kReachOfMargin = 8.0;

/// Number of searches that a list must serve to repay its wide search.
constexpr int kWorthwhile = 4;

/// Maximum fraction of vertices out of bounds [-]; their pairs take a separate search.
constexpr double kMaxOutOfBounds = 0.03;

/// Pairs per vertex [-] above which testing a list takes as long as a search, as in deep stacks. After such a
/// list, the next kPause searches go without one.
constexpr int kMaxPairs = 32, kPause = 64;

/// Distance beyond the limit at which a pair is refused regardless of rounding [m].
constexpr double kRounding = 1e-9;

/// Mean of the values; 0 if there are none.
Vec3 mean(View<const Vec3> values)
{
    const Vec3 zero = Vec3::Zero();
    return values.empty() ? zero
                          : Vec3(parallel_sum(kCpu, values.size(), zero, [&](int i) { return values[i]; }) /
                                 values.size());
}

} // namespace

void KeptPairs::Excursion::add(const Excursion& other)
{
    come = std::max(come, other.come);
    goes = std::max(goes, other.goes);
    slack = std::max(slack, other.slack);
}

KeptPairs::Plan KeptPairs::plan(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    const bool asks_for_all = trajectories.selected.empty();
    if (base_.empty() || (!asks_for_all && !has_list_)) {
        if (asks_for_all)
            begin_at(x);
        return Plan::kSearch;
    }

    measure(x, trajectories);
    if (has_list_ && are_few(mark_out_of_bounds(reach(margin)))) {
        uses_ += asks_for_all;
        return Plan::kUse;
    }
    if (!asks_for_all)
        return Plan::kSearch;
    if (pause_ == 0 && would_serve(margin))
        return Plan::kKeep;
    pause_ = std::max(0, pause_ - 1);
    begin_at(x);
    return Plan::kSearch;
}

/// Whether a list made now would serve this search and a few more. Judged by the uses of the last list, or
/// without one by the motion since the last search.
bool KeptPairs::would_serve(double margin)
{
    const double reach = 0.5 * (wide(margin) - margin);
    if (!(reach > 0.0))
        return false;
    if (!has_list_)
        return are_few(mark_out_of_bounds(reach / kWorthwhile));
    const auto is_fast = [&](const Excursion& excursion) { return !(excursion.goes <= reach - max_.slack); };
    return uses_ >= kWorthwhile &&
           are_few(int(std::count_if(excursions_.begin(), excursions_.end(), is_fast)));
}

double KeptPairs::wide(double margin) const
{
    return margin + 2.0 * std::min(kReachOfEdge * mean_edge_, kReachOfMargin * margin);
}

/// Reach of the current list [m].
double KeptPairs::reach(double margin) const { return 0.5 * (complete_to_ - margin - kRounding); }

void KeptPairs::keep(View<const Vec3> x, const Trajectories& trajectories, double margin)
{
    begin_at(x);
    has_list_ = true;
    complete_to_ = wide(margin);
    if (vertex_triangle_.size() + edge_edge_.size() > size_t(kMaxPairs) * size_t(x.size()))
        pause_ = kPause;
    measure(x, trajectories);
    mark_out_of_bounds(reach(margin));
}

/// Starts from x without a list.
void KeptPairs::begin_at(View<const Vec3> x)
{
    base_.assign(x.begin(), x.end());
    base_mean_ = mean(x);
    has_list_ = false;
    uses_ = 0;
}

void KeptPairs::measure(View<const Vec3> x, const Trajectories& trajectories)
{
    const int n = x.size();
    const Vec3 common_motion = mean(trajectories.motion);
    const Vec3 common = mean(x) - base_mean_;
    excursions_.resize(n);
    parallel_for(kCpu, "collision/cloth_excursions", n, [&](int v) {
        Excursion& excursion = excursions_[v];
        excursion.come = (x[v] - base_[v] - common).norm();
        excursion.goes = trajectories.motion.empty() ? 0.0 : (trajectories.motion[v] - common_motion).norm();
        excursion.slack = trajectories.slack.empty() ? 0.0 : trajectories.slack[v];
    });
    max_ = {};
    for (const Excursion& excursion : excursions_)
        max_.add(excursion);
    if (!(common + common_motion).allFinite()) // then no excursion is finite either
        max_.come = std::numeric_limits<double>::infinity();
}

/// The largest components of a side's excursion may belong to different vertices, so each component has a
/// separate bound: its maximum, if that leaves enough for the others.
int KeptPairs::mark_out_of_bounds(double reach)
{
    out_of_bounds_count_ = 0;
    if (max_.sum() <= reach)
        return 0;
    out_of_bounds_.assign(excursions_.size(), 0);
    const double left = reach - max_.slack;
    const double goes = max_.come <= 0.5 * left ? left - max_.come : std::min(max_.goes, 0.5 * left);
    const Excursion bound{left - goes, goes, max_.slack};
    for (size_t v = 0; v < excursions_.size(); ++v)
        if (!(excursions_[v].come <= bound.come && excursions_[v].goes <= bound.goes)) {
            out_of_bounds_[v] = 1;
            ++out_of_bounds_count_;
        }
    return out_of_bounds_count_;
}

bool KeptPairs::are_few(int vertices) const
{
    return vertices <= kMaxOutOfBounds * double(excursions_.size());
}

bool KeptPairs::may_meet(const Pair& pair, const std::array<int, 4>& vertices, bool is_edge_edge,
                         double margin) const
{
    Excursion side[2];
    for (int k = 0; k < 4; ++k) {
        if (has_out_of_bounds() && out_of_bounds_[vertices[k]] != 0)
            return false;
        side[k < first_count(is_edge_edge) ? 0 : 1].add(excursions_[vertices[k]]);
    }
    return pair.distance <= margin + side[0].sum() + side[1].sum() + kRounding;
}

} // namespace toile::collision
