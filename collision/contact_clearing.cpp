#include <algorithm>
#include <limits>

#include "collision/collider_pairs.h"
#include "collision/contact.h"
#include "collision/near_sweeps.h"

/// How contact moves cloth out of surfaces, pair by pair, where no minimisation does it.
namespace toile {

namespace {

/// Sweeps over the pairs at the end of a step: neighbouring planes push against each other.
constexpr int kClearSweeps = 5;

/// Farthest move of a vertex for a pair in such a sweep, of the shortest altitude around the pair [-]: a
/// millimetre across a sliver would be an explosion.
constexpr double kClearance = 0.5;

/// Clearance [m] below which velocities are left alone too: one vertex of a sliver stopped, the others not.
constexpr double kThinnest = 5e-5;

/// Least sum of squared weights of a pair's free vertices for which the pair is cleared by moving them [-].
/// Where fixed vertices carry nearly all of the pair, the free one would have to be thrown far; the energy
/// deals with it.
constexpr double kMinLeverage = 0.1;

} // namespace

/// Vertices that no pair moves by itself.
bool Contact::is_held(int vertex) const
{
    return start_.fixed[vertex] || (!rigid_.empty() && rigid_[vertex] >= 0);
}

/// Sum of squared weights of the pair's free vertices [-]: how far its cloth point goes when each of them
/// moves by its weight. 0 where fixed vertices carry nearly all of the pair.
double Contact::leverage_of(const ContactPair& pair) const
{
    double squares = 0.0;
    for (int k = 0; k < pair.count(); ++k)
        if (!is_held(pair.vertex[k]))
            squares += pair.weight[k] * pair.weight[k];
    return squares < kMinLeverage ? 0.0 : squares;
}

/// Adds to the field at the pair's free vertices so that its cloth point moves by `move`. False where fixed
/// vertices carry nearly all of the pair.
bool Contact::push(const ContactPair& pair, const Vec3& move, View<Vec3> field) const
{
    const double leverage = leverage_of(pair);
    if (leverage == 0.0)
        return false;
    for (int k = 0; k < pair.count(); ++k)
        if (!is_held(pair.vertex[k]))
            field[pair.vertex[k]] += pair.weight[k] / leverage * move;
    return true;
}

/// Takes back what slips, as far as friction holds it, and pushes out at once: pairs that share a vertex
/// share its depth. Velocities obey the same law by themselves: a method of many substeps ends faster than it
/// has moved.
void Contact::rub(StepField positions, StepField velocities) const
{
    const NearTerms all =
        terms_->near(std::numeric_limits<double>::infinity(), false); // sees x before it changes
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    const auto at_most = [](const Vec3& move, double limit) {
        const double length = move.norm();
        return length > limit ? Vec3(limit / length * move) : move;
    };
    for (const ContactTerm& term : all.terms) {
        const double depth = -term.gap(x);
        if (depth <= 0.0)
            continue;
        const ContactPair& pair = term.pair;
        const double clearance = clearance_of(pair);
        push(pair, at_most(-term.slip(x), term.friction * depth), x);
        push(pair, std::clamp(depth - term.give, 0.0, clearance) * pair.normal, x);

        const Vec3 lag = surface_velocity(pair) - pair.cloth_point(v);
        const double approach = pair.normal.dot(lag);
        if (approach > 0.0 && clearance >= kThinnest)
            push(pair,
                 approach * pair.normal + at_most(lag - approach * pair.normal, term.friction * approach), v);
    }
}

/// @param most  depth that is left to a pair which rests there [m]
void Contact::push_out(StepField positions, double most) const
{
    sweep_near(positions, ExpectedMoves::Short, [&](const NearTerms& near, NearMoves& moves) {
        bool is_still = false; // a sweep that changes nothing would change nothing again
        for (int sweep = 0; sweep < kClearSweeps && !is_still; ++sweep) {
            is_still = true;
            for (int i = 0; i < near.terms.size(); ++i) {
                const ContactTerm& term = near.terms[i];
                const double depth = -term.gap(near.x) - term.give - std::min(most, term.rest_depth());
                if (depth <= 0.0)
                    continue;
                push(term.pair, std::min(depth, clearance_of(term.pair)) * term.pair.normal, near.x);
                is_still = false;
                if (!moves.note(i))
                    return false;
            }
        }
        return true;
    });
}

/// Velocity of the surface at the pair [m/s]; 0 where it jumped.
Vec3 Contact::surface_velocity(const ContactPair& pair) const
{
    const bool is_carried = pair.motion.norm() <= ColliderPairs::kMaxCarrySpeed * start_.dt;
    return is_carried ? Vec3(pair.motion / start_.dt) : Vec3(Vec3::Zero());
}

/// Cloth inside moves at least as fast out of a surface as that does.
void Contact::stop_at_surfaces(StepField velocities) const
{
    const NearTerms near = terms_->near(0.0, false, velocities);
    std::vector<int> changed;
    for (int i = 0; i < near.terms.size(); ++i) {
        const ContactTerm& term = near.terms[i];
        if (term.gap(near.x) >= 0.0)
            continue;
        const ContactPair& pair = term.pair;
        if (clearance_of(pair) < kThinnest)
            continue;
        if (const double approach = pair.normal.dot(surface_velocity(pair) - pair.cloth_point(near.v));
            approach > 0.0 && push(pair, approach * pair.normal, near.v))
            changed.push_back(i);
    }
    terms_->take(near, changed);
}

/// How far a pair may be pushed in a sweep without crushing a triangle [m].
double Contact::clearance_of(const ContactPair& pair) const
{
    double shortest = std::numeric_limits<double>::max(), largest = 0.0;
    for (int k = 0; k < pair.count(); ++k) {
        shortest = std::min(shortest, altitude_[pair.vertex[k]]);
        if (!is_held(pair.vertex[k]))
            largest = std::max(largest, pair.weight[k]);
    }
    return largest > 0.0 ? kClearance * shortest * leverage_of(pair) / largest : 0.0;
}

} // namespace toile
