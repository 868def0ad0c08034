#include <algorithm>

#include "collision/contact.h"

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

/// Gauss-Seidel over the pairs, with masses and the compliance 1/w of their springs [Macklin et al. 2016, eq.
/// 18] and forces that never pull. Momentum goes where contact sends it, and pairs that press begin as deep
/// as their force asks for: friction reads it from there.
bool Contact::make_feasible(StepField positions) const
{
    if (energy_.terms().empty())
        return false;
    const View<Vec3> x = positions.change_on_host();
    const std::vector<ContactTerm>& terms = energy_.terms();
    std::vector<double> mobility, force(terms.size(), 0.0);
    for (const ContactTerm& term : terms)
        mobility.push_back(mobility_of(term.pair));

    bool moved = false;
    for (int sweep = 0; sweep < kSweeps; ++sweep)
        for (int i = 0; i < int(terms.size()); ++i) {
            const double compliance = 1.0 / terms[i].stiffness;
            const double depth = -energy_.gap(i, x) - terms[i].give - compliance * force[i];
            const double change = std::max(-force[i], depth / (compliance + mobility[i]));
            if (mobility[i] == 0.0 || change == 0.0)
                continue;
            force[i] += change;
            accelerate(terms[i].pair, change, x);
            moved = true;
        }
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
