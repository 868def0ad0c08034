#include "collision/cloth/kept_pairs.h"

#include <algorithm>
#include <limits>

#include "collision/cloth/pair_geometry.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// What vertices may do beside all others before a list misses them, of the mean edge and of the margin [-],
/// the smaller of both. More lasts longer; but from a third of an edge on neighbours in the same cloth are
/// pairs too, and in a stack every layer is one of as many others as there are margins in it.
constexpr double kReachOfEdge = 0.25, kReachOfMargin = 8.0;

/// Searches that a list must serve to be worth the wide search that it takes.
constexpr int kWorthwhile = 4;

/// Share of vertices [-] that may be strays: their pairs take a search of their own.
constexpr double kMostStrays = 0.03;

/// Pairs a vertex [-] that take as long to look at as to search for, and for how many searches it is not
/// tried again where there were more: in deep stacks.
constexpr int kMostPairs = 32, kPause = 64;

/// Farther apart by this than asked for, a pair is refused whatever rounding does to its distance [m].
constexpr double kRounding = 1e-9;

/// 0 where there are none.
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

KeptPairs::Plan KeptPairs::plan(View<const Vec3> x, const Ways& ways, double margin)
{
    const bool asks_for_all = ways.around.empty();
    if (base_.empty() || (!asks_for_all && !has_list_)) {
        if (asks_for_all)
            begin_at(x);
        return Plan::kSearch;
    }

    measure(x, ways);
    if (has_list_ && are_few(mark_strays(reach(margin)))) {
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

/// Whether a list made now would do for this search and a few more, by what the last has done, or else by how
/// cloth has moved since the last search.
bool KeptPairs::would_serve(double margin)
{
    const double reach = 0.5 * (wide(margin) - margin);
    if (!(reach > 0.0))
        return false;
    if (!has_list_)
        return are_few(mark_strays(reach / kWorthwhile));
    const auto is_fast = [&](const Excursion& own) { return !(own.goes <= reach - most_.slack); };
    return uses_ >= kWorthwhile &&
           are_few(int(std::count_if(excursions_.begin(), excursions_.end(), is_fast)));
}

double KeptPairs::wide(double margin) const
{
    return margin + 2.0 * std::min(kReachOfEdge * mean_edge_, kReachOfMargin * margin);
}

/// Of the list that there is.
double KeptPairs::reach(double margin) const { return 0.5 * (complete_to_ - margin - kRounding); }

void KeptPairs::keep(View<const Vec3> x, const Ways& ways, double margin)
{
    begin_at(x);
    has_list_ = true;
    complete_to_ = wide(margin);
    if (vertex_triangle_.size() + edge_edge_.size() > size_t(kMostPairs) * size_t(x.size()))
        pause_ = kPause;
    measure(x, ways);
    mark_strays(reach(margin));
}

/// Without a list.
void KeptPairs::begin_at(View<const Vec3> x)
{
    base_.assign(x.begin(), x.end());
    base_mean_ = mean(x);
    has_list_ = false;
    uses_ = 0;
}

void KeptPairs::measure(View<const Vec3> x, const Ways& ways)
{
    const int n = x.size();
    const Vec3 common_motion = mean(ways.motion);
    const Vec3 common = mean(x) - base_mean_;
    excursions_.resize(n);
    parallel_for(kCpu, "collision/cloth_excursions", n, [&](int v) {
        Excursion& own = excursions_[v];
        own.come = (x[v] - base_[v] - common).norm();
        own.goes = ways.motion.empty() ? 0.0 : (ways.motion[v] - common_motion).norm();
        own.slack = ways.slack.empty() ? 0.0 : ways.slack[v];
    });
    most_ = {};
    for (const Excursion& own : excursions_)
        most_.add(own);
    if (!(common + common_motion).allFinite()) // nor is any excursion
        most_.come = std::numeric_limits<double>::infinity();
}

/// Vertices of a side may differ in which of the three they spend most of, so each has a bound of its own:
/// what is spent of it where that leaves enough for the others.
int KeptPairs::mark_strays(double reach)
{
    stray_count_ = 0;
    if (most_.sum() <= reach)
        return 0;
    strays_.assign(excursions_.size(), 0);
    const double left = reach - most_.slack;
    const double goes = most_.come <= 0.5 * left ? left - most_.come : std::min(most_.goes, 0.5 * left);
    const Excursion bound{left - goes, goes, most_.slack};
    for (size_t v = 0; v < excursions_.size(); ++v)
        if (!(excursions_[v].come <= bound.come && excursions_[v].goes <= bound.goes)) {
            strays_[v] = 1;
            ++stray_count_;
        }
    return stray_count_;
}

bool KeptPairs::are_few(int vertices) const { return vertices <= kMostStrays * double(excursions_.size()); }

bool KeptPairs::may_meet(const Pair& pair, const std::array<int, 4>& vertices, bool is_edge_edge,
                         double margin) const
{
    Excursion side[2];
    for (int k = 0; k < 4; ++k) {
        if (has_strays() && strays_[vertices[k]] != 0)
            return false;
        side[k < first_count(is_edge_edge) ? 0 : 1].add(excursions_[vertices[k]]);
    }
    return pair.distance <= margin + side[0].sum() + side[1].sum() + kRounding;
}

} // namespace toile
