#pragma once

#include <map>
#include <tuple>

#include "collision/contact_term.h"

namespace toile {

/// What a pair that pressed hands on to its successors, from look to look and from step to step: how hard it
/// pressed and how far it had stuck. The same bodies on CPU and GPU.
struct ContactRecord {
    /// cos of the angle up to which a pair's normal may turn and still be the same contact [-].
    static constexpr double kSameContact = 0.7;

    ContactKind kind = ContactKind::kVertexFace;
    int collider = -1;
    std::array<int, 4> vertex{-1, -1, -1, -1};
    double normal_force = 0.0;  ///< [N]
    double pressing = 0.0;      ///< [N] its successor
    Vec3 normal = Vec3::Zero(); ///< unit
    Vec3 stick = Vec3::Zero();  ///< [m] elastic part of the slip

    /// Of a pair, with nothing to hand on. Cloth's vertex on cloth is the same contact on whichever triangle
    /// it has come to.
    TOILE_HD static ContactRecord of(const ContactPair& pair)
    {
        ContactRecord record;
        record.kind = pair.kind;
        record.collider = pair.collider;
        record.vertex = pair.vertex;
        if (pair.kind == ContactKind::kClothVertexFace)
            for (int k = 1; k < 4; ++k)
                record.vertex[k] = -1;
        return record;
    }

    /// Of a term that presses or did; friction holds no more of its slip than Coulomb allows.
    /// @param slip  what has slipped since the anchor [m]
    TOILE_HD static ContactRecord of(const ContactTerm& term, const Vec3& slip)
    {
        ContactRecord record = of(term.pair);
        record.normal_force = term.normal_force;
        record.pressing = term.pressing;
        record.normal = term.pair.normal;
        record.stick = slip;
        if (const double pull = term.sticking_stiffness() * record.stick.norm();
            pull > term.friction * record.normal_force)
            record.stick *= term.friction * record.normal_force / pull;
        return record;
    }

    /// True for the same kind, collider and vertices.
    TOILE_HD bool has_key_of(const ContactRecord& other) const
    {
        return kind == other.kind && collider == other.collider && vertex[0] == other.vertex[0] &&
               vertex[1] == other.vertex[1] && vertex[2] == other.vertex[2] && vertex[3] == other.vertex[3];
    }

    /// Gives a term of the same key what it has, if their normals are nearly the same; false where not.
    TOILE_HD bool hand_on(ContactTerm& term) const
    {
        const Vec3& n = term.pair.normal;
        if (normal.dot(n) < kSameContact)
            return false;
        term.normal_force = normal_force;
        term.pressing = pressing;
        term.anchor -= stick - n.dot(stick) * n;
        return true;
    }
};

/// What pairs that press have left, by their keys.
class ContactMemory {
public:
    void forget() { known_.clear(); }
    int size() const { return int(known_.size()); }

    /// Keeps a term that presses.
    /// @param slip  what has slipped since the anchor [m]
    void keep(const ContactTerm& term, const Vec3& slip);

    /// Gives a new term what the first with its key and nearly its normal had, if one is known.
    void hand_on(ContactTerm& term) const;

private:
    using Key = std::tuple<ContactKind, int, std::array<int, 4>>;
    static Key key_of(const ContactRecord& record) { return {record.kind, record.collider, record.vertex}; }

    std::multimap<Key, ContactRecord> known_;
};

} // namespace toile
