#pragma once

#include <map>
#include <tuple>

#include "collision/contact/term.h"

namespace toile::collision {

/// Warm-start data of a pair that pressed, for its successors within the step and in the next: normal force,
/// shift of its spring and elastic slip. The same bodies on CPU and GPU.
struct ContactRecord {
    /// Cosine of the maximum angle between the normals of the same contact [-].
    static constexpr double kSameContact = 0.7;

    ContactKind kind = ContactKind::kVertexFace;
    int collider = -1;
    std::array<int, 4> vertex{-1, -1, -1, -1};
    std::array<int, 3> face{-1, -1, -1}; ///< other side, if the key leaves it out: vertices, or a feature
    double normal_force = 0.0;           ///< [N]
    double pressing = 0.0;               ///< [N] its successor
    ContactMultiplier multiplier;
    Vec3 normal = Vec3::Zero(); ///< unit
    Vec3 stick = Vec3::Zero();  ///< [m] elastic part of the slip

    /// Record of a pair, without warm-start data. A cloth vertex on cloth is the same contact on any
    /// triangle.
    TOILE_HD static ContactRecord of(const ContactPair& pair)
    {
        ContactRecord record;
        record.kind = pair.kind;
        record.collider = pair.collider;
        record.vertex = pair.vertex;
        record.face[0] = pair.feature;
        if (pair.kind == ContactKind::kClothVertexFace)
            for (int k = 1; k < 4; ++k) {
                record.face[k - 1] = pair.vertex[k];
                record.vertex[k] = -1;
            }
        return record;
    }

    /// Record of a term that presses or has pressed. Its slip is limited to the elastic part that Coulomb's
    /// law allows.
    /// @param slip  slip since the anchor [m]
    TOILE_HD static ContactRecord of(const ContactTerm& term, const Vec3& slip)
    {
        ContactRecord record = of(term.pair);
        record.normal_force = term.normal_force;
        record.pressing = term.pressing;
        record.multiplier = term.multiplier;
        record.normal = term.pair.normal;
        record.stick = slip;
        if (const double pull = term.sticking_stiffness() * record.stick.norm();
            pull > term.friction * record.normal_force)
            record.stick *= term.friction * record.normal_force / pull;
        return record;
    }

    /// True if kind, collider and vertices are the same.
    TOILE_HD bool has_key_of(const ContactRecord& other) const
    {
        return kind == other.kind && collider == other.collider && vertex[0] == other.vertex[0] &&
               vertex[1] == other.vertex[1] && vertex[2] == other.vertex[2] && vertex[3] == other.vertex[3];
    }
};

/// Warm start of a new term by the records that have its key: forces and slip of the first with nearly its
/// normal, and the multiplier of the same pair, or else the largest, for a term that has one.
struct WarmStart {
    ContactTerm& term;
    ContactRecord key = ContactRecord::of(term.pair);
    bool is_known = false, is_same_pair = false;

    TOILE_HD void consider(const ContactRecord& record)
    {
        const Vec3& n = term.pair.normal;
        if (record.normal.dot(n) < ContactRecord::kSameContact)
            return;
        const bool is_same =
            record.face[0] == key.face[0] && record.face[1] == key.face[1] && record.face[2] == key.face[2];
        if (term.has_min_gap() &&
            (!is_known || (!is_same_pair && (is_same || record.multiplier.shift > term.multiplier.shift)))) {
            term.multiplier = record.multiplier;
            term.spring.shift = record.multiplier.shift;
        }
        if (!is_known) {
            term.normal_force = record.normal_force;
            term.pressing = record.pressing;
            term.anchor -= record.stick - n.dot(record.stick) * n;
        }
        is_known = true;
        is_same_pair = is_same_pair || is_same;
    }
};

/// Records of pressing pairs, by their keys.
class ContactMemory {
public:
    void forget() { known_.clear(); }
    int size() const { return int(known_.size()); }

    /// Stores a term that presses.
    /// @param slip  slip since the anchor [m]
    void keep(const ContactTerm& term, const Vec3& slip);

    /// See WarmStart.
    void warm_start(ContactTerm& term) const;

private:
    using Key = std::tuple<ContactKind, int, std::array<int, 4>>;
    static Key key_of(const ContactRecord& record) { return {record.kind, record.collider, record.vertex}; }

    std::multimap<Key, ContactRecord> known_;
};

} // namespace toile::collision
