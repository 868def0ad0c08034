#include "collision/contact_memory.h"

namespace toile {

namespace {

/// cos of the angle up to which a pair's normal may turn and still be the same contact [-].
constexpr double kSameContact = 0.7;

} // namespace

void ContactMemory::keep(const ContactTerm& term, const Vec3& slip)
{
    const double force = term.normal_force;
    if (force == 0.0)
        return;
    Vec3 stick = slip;
    if (const double pull = term.stiffness * stick.norm(); pull > term.friction * force)
        stick *= term.friction * force / pull;
    known_.emplace(Key{term.pair.kind, term.pair.collider, term.pair.vertex},
                   Entry{term.pair.normal, force, stick});
}

void ContactMemory::hand_on(ContactTerm& term) const
{
    const Vec3& normal = term.pair.normal;
    const auto [first, last] = known_.equal_range(Key{term.pair.kind, term.pair.collider, term.pair.vertex});
    for (auto known = first; known != last; ++known) {
        const Entry& entry = known->second;
        if (entry.normal.dot(normal) < kSameContact)
            continue;
        term.normal_force = entry.normal_force;
        term.anchor -= entry.stick - normal.dot(entry.stick) * normal;
        return;
    }
}

} // namespace toile
