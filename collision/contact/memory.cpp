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
    const auto [first, last] = known_.equal_range(key_of(ContactRecord::of(term.pair)));
    for (auto known = first; known != last; ++known)
        if (known->second.warm_start(term))
            return;
}

} // namespace toile::collision
