#include "collision/contact_memory.h"

#include <algorithm>

namespace toile {

namespace {

/// cos of the angle up to which a pair's normal may turn and still be the same contact [-].
constexpr double kSameContact = 0.7;

} // namespace

ContactMemory::Key ContactMemory::key_of(const ContactPair& pair)
{
    std::array<int, 4> vertex = pair.vertex;
    if (pair.kind == ContactKind::kClothVertexFace)
        std::fill(vertex.begin() + 1, vertex.end(), -1);
    return {pair.kind, pair.collider, vertex};
}

void ContactMemory::keep(const ContactTerm& term, const Vec3& slip)
{
    const double force = term.normal_force;
    if (force == 0.0)
        return;
    Vec3 stick = slip;
    if (const double pull = term.stiffness * stick.norm(); pull > term.friction * force)
        stick *= term.friction * force / pull;
    known_.emplace(key_of(term.pair), Entry{term.pair.normal, force, stick});
}

void ContactMemory::hand_on(ContactTerm& term) const
{
    const Vec3& normal = term.pair.normal;
    const auto [first, last] = known_.equal_range(key_of(term.pair));
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
