#include "collision/contact.h"
#include "collision/near_sweeps.h"

/// Where contact alone takes the start guess of a step.
namespace toile {

namespace {

/// Sweeps over the pairs. With one the normal forces of the first minimisation are too large where many pairs
/// share vertices, and friction stops what should slide; with eight nothing changes
/// (docs/collision/contact.md).
constexpr int kSweeps = 4;

} // namespace

/// How far a force on the pair's cloth point moves it in the step [m/N]: dt^2 sum_k b_k^2 / m_k over the free
/// vertices. 0 where fixed ones carry nearly all of the pair.
double Contact::mobility_of(const ContactPair& pair) const
{
    if (leverage_of(pair) == 0.0)
        return 0.0;
    double mobility = 0.0;
    for (int k = 0; k < pair.count(); ++k)
        if (const int v = pair.vertex[k]; !is_held(v))
            mobility += pair.weight[k] * pair.weight[k] / start_.masses[v];
    return start_.dt * start_.dt * mobility;
}

/// Gauss-Seidel over the pairs, with masses and the compliance of their springs [Macklin et al. 2016, eq. 18]
/// and forces that never pull. Momentum goes where contact sends it, and pairs that press begin as deep
/// as their force asks for: friction reads it from there.
bool Contact::make_feasible(StepField positions, ExpectedMoves expected) const
{
    constexpr double kUnknown = -1.0;
    bool moved = false;
    std::vector<double> mobility, force;
    sweep_near(positions, expected, [&](const NearTerms& near, NearMoves& moves) {
        moved = false;
        force.assign(near.terms.size(), 0.0);
        mobility.assign(near.terms.size(), kUnknown);
        bool is_still = false; // a sweep that changes nothing would change nothing again
        for (int sweep = 0; sweep < kSweeps && !is_still; ++sweep) {
            is_still = true;
            for (int i = 0; i < near.terms.size(); ++i) {
                const ContactTerm& term = near.terms[i];
                const double depth = -term.gap(near.x) - term.give;
                if (depth <= 0.0 && force[i] == 0.0)
                    continue;
                if (mobility[i] == kUnknown)
                    mobility[i] = mobility_of(term.pair);
                const double reach = depth + mobility[i] * force[i];
                const double change =
                    term.spring.force(term.spring.depth_at_rest(reach, mobility[i])) - force[i];
                if (mobility[i] == 0.0 || change == 0.0)
                    continue;
                force[i] += change;
                accelerate(term.pair, change, near.x);
                moved = true;
                is_still = false;
                if (!moves.note(i))
                    return false;
            }
        }
        return true;
    });
    return moved;
}

/// Moves the pair's free vertices as a force [N] along its normal would in this step.
void Contact::accelerate(const ContactPair& pair, double force, View<Vec3> x) const
{
    for (int k = 0; k < pair.count(); ++k)
        if (const int v = pair.vertex[k]; !is_held(v))
            x[v] += start_.dt * start_.dt * force * pair.weight[k] / start_.masses[v] * pair.normal;
}

} // namespace toile
