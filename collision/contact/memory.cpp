#include "collision/contact/memory.h"

namespace toile::collision {

void ContactMemory::keep(const ContactTerm& term, const Vec3& slip)
{
    if (!term.has_pressed())
        return;
    const ContactRecord record = ContactRecord::of(term, slip);
    known_.emplace(key_of(record), record);
}

void ContactMemory::warm_start(ContactTerm& term) const
{
    WarmStart start{term};
    const auto [first, last] = known_.equal_range(key_of(start.key));
    for (auto known = first; known != last; ++known)
        start.consider(known->second);
}

} // namespace toile::collision
