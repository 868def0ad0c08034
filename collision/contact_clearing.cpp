#include <algorithm>
#include <limits>

#include "collision/contact.h"

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

/// Distance on top of the gap, of the gap [-], up to which cloth counts as lying on a collider.
constexpr double kLeaning = 0.25;

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

double Contact::deepest(View<const Vec3> x) const
{
    double depth = 0.0;
    for (int i = 0; i < int(energy_.terms().size()); ++i)
        if (!energy_.terms()[i].pair.is_between_cloths())
            depth = std::max(depth, -energy_.gap(i, x) - energy_.terms()[i].give);
    return depth;
}

/// Takes back what slips, as far as friction holds it, and pushes out at once: pairs that share a vertex
/// share its depth. Velocities obey the same law by themselves: a method of many substeps ends faster than it
/// has moved.
void Contact::rub(View<Vec3> x, View<Vec3> v) const
{
    const auto at_most = [](const Vec3& move, double limit) {
        const double length = move.norm();
        return length > limit ? Vec3(limit / length * move) : move;
    };
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const double depth = -energy_.gap(i, x);
        if (depth <= 0.0)
            continue;
        const ContactTerm& term = energy_.terms()[i];
        const ContactPair& pair = term.pair;
        const double clearance = clearance_of(pair);
        push(pair, at_most(-energy_.slip(i, x), term.friction * depth), x);
        push(pair, std::clamp(depth - term.give, 0.0, clearance) * pair.normal, x);

        const Vec3 lag = surface_velocity(pair) - pair.cloth_point(v);
        const double approach = pair.normal.dot(lag);
        if (approach > 0.0 && clearance >= kThinnest)
            push(pair,
                 approach * pair.normal + at_most(lag - approach * pair.normal, term.friction * approach), v);
    }
}

void Contact::push_out(View<Vec3> x) const
{
    for (int sweep = 0; sweep < kClearSweeps; ++sweep)
        for (int i = 0; i < int(energy_.terms().size()); ++i) {
            const ContactPair& pair = energy_.terms()[i].pair;
            if (const double depth = -energy_.gap(i, x) - energy_.terms()[i].give; depth > 0.0)
                push(pair, std::min(depth, clearance_of(pair)) * pair.normal, x);
        }
}

/// Velocity of the surface at the pair [m/s]; 0 where it jumped.
Vec3 Contact::surface_velocity(const ContactPair& pair) const
{
    return is_carried(pair.motion) ? Vec3(pair.motion / start_.dt) : Vec3(Vec3::Zero());
}

/// Cloth inside moves at least as fast out of a surface as that does.
void Contact::stop_at_surfaces(View<const Vec3> x, View<Vec3> v) const
{
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        if (energy_.gap(i, x) >= 0.0)
            continue;
        const ContactPair& pair = energy_.terms()[i].pair;
        if (clearance_of(pair) < kThinnest)
            continue;
        if (const double approach = pair.normal.dot(surface_velocity(pair) - pair.cloth_point(v));
            approach > 0.0)
            push(pair, approach * pair.normal, v);
    }
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

/// Cloth that lies on a collider, or is in it: 1 for each such vertex.
std::vector<unsigned char> Contact::leaning(View<const Vec3> x) const
{
    std::vector<unsigned char> leans(x.size(), 0);
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const ContactPair& pair = energy_.terms()[i].pair;
        if (!pair.is_between_cloths() && energy_.gap(i, x) <= kLeaning * gap_of(pair))
            for (int k = 0; k < pair.count(); ++k)
                leans[pair.vertex[k]] = 1;
    }
    return leans;
}

} // namespace toile
