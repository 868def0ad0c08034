#pragma once

#include <map>
#include <tuple>

#include "collision/contact_energy.h"

namespace toile {

/// What pairs that press hand on to their successors, from look to look and from step to step: how hard they
/// pressed and how far they had stuck.
class ContactMemory {
public:
    void forget() { known_.clear(); }
    int size() const { return int(known_.size()); }

    /// Keeps a term that presses; friction holds no more of its slip than Coulomb allows.
    /// @param slip  what has slipped since the anchor [m]
    void keep(const ContactTerm& term, const Vec3& slip);

    /// Gives a new term what the same pair (kind, collider, vertices, nearly the same normal) had, if it is
    /// known.
    void hand_on(ContactTerm& term) const;

private:
    using Key = std::tuple<ContactKind, int, std::array<int, 4>>;

    /// Cloth's vertex on cloth is the same contact on whichever triangle it has come to.
    static Key key_of(const ContactPair& pair);

    struct Entry {
        Vec3 normal;         ///< unit
        double normal_force; ///< [N]
        Vec3 stick;          ///< [m] elastic part of the slip
    };

    std::multimap<Key, Entry> known_;
};

} // namespace toile
