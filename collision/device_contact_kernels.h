#pragma once

/// How terms are made, listed by vertex and remembered on a GPU, and what the energy adds up there.

#include <cstdint>

#include "collision/acting_entries.h"
#include "collision/contact_kernels.h"
#include "collision/contact_memory.h"
#include "collision/device_pair_kernels.h"
#include "core/backend/lanes.h"

namespace toile {

/// Of a record's key [Steele et al. 2014, SplitMix64].
TOILE_HD inline std::uint64_t hash_of(const ContactRecord& record)
{
    std::uint64_t hash = 0;
    const int parts[6] = {int(record.kind), record.collider,  record.vertex[0],
                          record.vertex[1], record.vertex[2], record.vertex[3]};
    for (const int part : parts) {
        hash += std::uint64_t(unsigned(part)) + 0x9e3779b97f4a7c15ULL;
        hash = (hash ^ (hash >> 30)) * 0xbf58476d1ce4e5b9ULL;
        hash = (hash ^ (hash >> 27)) * 0x94d049bb133111ebULL;
        hash ^= hash >> 31;
    }
    return hash;
}

/// What is remembered, by its hashes.
struct KnownContacts {
    View<const std::uint64_t> hashes; ///< [records] ascending
    View<const int> order;            ///< [records] whose hashes these are; ascending where hashes are equal
    View<const ContactRecord> records;

    /// As ContactMemory.
    TOILE_HD void hand_on(ContactTerm& term) const
    {
        const ContactRecord key = ContactRecord::of(term.pair);
        const std::uint64_t hash = hash_of(key);
        int first = 0;
        for (int count = records.size(); count > 0;) {
            const int half = count / 2;
            if (hashes[first + half] < hash) {
                first += half + 1;
                count -= half + 1;
            } else {
                count = half;
            }
        }
        for (int i = first; i < records.size() && hashes[i] == hash; ++i)
            if (const ContactRecord& record = records[order[i]];
                record.has_key_of(key) && record.hand_on(term))
                return;
    }
};

/// Flags the terms that press.
struct FlagPressing {
    View<const ContactTerm> terms;
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = terms[i].has_pressed() ? 1 : 0; }
};

/// Keeps record i, of a term that presses.
struct RememberTerm {
    View<const ContactTerm> terms;
    ContactRules rules;
    RememberedSlip slip;
    View<const Vec3> x;       ///< [vertices] [m]
    View<const int> pressing; ///< [records] terms
    View<ContactRecord> records;
    View<std::uint64_t> hashes;
    View<int> numbers;
    TOILE_HD void operator()(int i) const
    {
        const ContactTerm& term = terms[pressing[i]];
        records[i] = ContactRecord::of(term, rules.slip_of(term, slip, x));
        hashes[i] = hash_of(records[i]);
        numbers[i] = i;
    }
};

/// Half of the room between each plane of a vertex and the one that opposes it most closely
/// (HostContactTerms::room_of), and the least of a vertex's.
struct FindRoom {
    PlanesOfVertices planes;
    View<const Vec3> found_at; ///< [vertices] [m]
    View<double> room;         ///< [pairs] out, of planes [m]
    View<double> overlap;      ///< [vertices] out: their least where that is negative, else 0 [m]

    TOILE_HD void operator()(int v) const
    {
        double least = 0.0;
        const int first = planes.first[v] - 1;
        for (int a = first; a >= 0 && planes.is_of(a, v); ++a) {
            const ContactPair& pair = planes.pairs[planes.pair[a]];
            double own = std::numeric_limits<double>::infinity();
            for (int b = first; planes.is_of(b, v); ++b) {
                const ContactPair& other = planes.pairs[planes.pair[b]];
                if (a == b || !are_opposing(pair, other))
                    continue;
                const double half = half_room(pair, other, found_at);
                own = half < own ? half : own;
            }
            room[planes.pair[a]] = own;
            least = own < least ? own : least;
        }
        overlap[v] = least;
    }
};

/// Pairs with colliders, then those of cloth with cloth.
struct PairsInTurn {
    View<const ContactPair> first, second;
    TOILE_HD const ContactPair& operator[](int i) const
    {
        return i < first.size() ? first[i] : second[i - first.size()];
    }
};

/// Flags the pairs that become terms: see ContactTerms::make.
struct FlagTerm {
    PairsInTurn pairs;
    ContactRules rules;
    View<const double> overlap; ///< [vertices] see FindRoom [m]
    View<unsigned char> flags;  ///< [pairs] out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[i];
        bool is_caught = false;
        for (int k = 0; k < pair.count() && !pair.is_between_cloths() && !is_plane(pair); ++k)
            is_caught = is_caught || overlap[pair.vertex[k]] < 0.0;
        flags[i] = !is_caught && !rules.is_fixed(pair) ? 1 : 0;
    }
};

/// Term i.
struct MakeTerm {
    PairsInTurn pairs;
    ContactRules rules;
    View<const double> room; ///< [pairs with colliders] see FindRoom [m]
    KnownContacts known;
    View<const int> list;    ///< [terms] pairs
    View<ContactTerm> terms; ///< out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[list[i]];
        ContactTerm term =
            rules.term_of(pair, is_plane(pair) ? room[list[i]] : std::numeric_limits<double>::infinity());
        known.hand_on(term);
        terms[i] = term;
    }
};

/// The vertices of terms as keys, and their entries (see ContactTouches).
struct KeyTouch {
    View<const ContactTerm> terms;
    View<std::uint64_t> keys; ///< [4 x terms] out
    View<int> entries;        ///< [4 x terms] out
    TOILE_HD void operator()(int e) const
    {
        const int v = terms[e / 4].pair.vertex[e % 4];
        keys[e] = v >= 0 ? std::uint64_t(v) : kNoVertex;
        entries[e] = e;
    }
};

/// Flags where the list of another vertex begins, and where the last one ends.
struct FlagLists {
    View<const std::uint64_t> keys; ///< [4 x terms] ascending
    View<unsigned char> flags;      ///< [4 x terms + 1] out
    TOILE_HD void operator()(int e) const
    {
        const std::uint64_t key = e < keys.size() ? keys[e] : kNoVertex;
        flags[e] = e == 0 || keys[e - 1] != key ? 1 : 0;
    }
};

/// Tells list k which vertex is its own, and that vertex.
struct NumberList {
    View<const int> first;          ///< [lists]
    View<const std::uint64_t> keys; ///< [4 x terms]
    View<int> vertices;             ///< [lists] out
    View<int> list_of;              ///< [vertices] out, 0 elsewhere
    TOILE_HD void operator()(int k) const
    {
        vertices[k] = int(keys[first[k]]);
        list_of[vertices[k]] = k + 1;
    }
};

/// Sums up what the threads of a team have: a vertex may be in many terms, and a kernel lasts as long as its
/// longest list.
template <typename Team, typename Numbers>
TOILE_HD Numbers team_sum(const Team& team, Numbers own)
{
    for (int k = 0; k < int(own.size()); ++k)
        own.data()[k] = team.sum(1, own.data()[k]);
    return own;
}

/// Evaluates and freezes a term.
struct EvaluateAndFreeze {
    EvaluateContact evaluate;
    FreezeContact freeze;
    /// The term: what it meets is all that changes.
    TOILE_HD ContactTerm early(int i) const { return evaluate.terms[i]; }

    TOILE_HD void operator()(int i) const { (*this)(i, early(i)); }
    TOILE_HD void operator()(int i, const ContactTerm& term) const
    {
        evaluate(i, term);
        freeze(i, term);
    }
};

/// Adds the forces on the vertex of list k, and the energies of the terms whose first vertex it is; bounds
/// their frozen Hessian, and lists those that act.
struct GatherContact {
    ContactTouches touches;
    View<const int> vertices;         ///< [lists]
    View<const Vec3> force;           ///< [terms] [N]
    View<const double> energy;        ///< [terms] [J]
    View<const FrozenContact> frozen; ///< [terms]
    View<Vec3> gradient;              ///< [vertices] added to [N]
    View<double> energy_shares;       ///< [vertices] added to, of the value [J]
    View<Mat3> blocks;                ///< [lists] out [N/m]
    ActingEntries acting;             ///< out

    /// Which entries a thread has, and the first of them.
    struct Early {
        int begin, end, entry;
    };
    template <typename Team>
    TOILE_HD Early early(int k, const Team& team, bool /*is_own*/) const
    {
        Early own{touches.first[k], touches.first[k + 1], 0};
        if (own.begin + team.thread < own.end)
            own.entry = touches.entries[own.begin + team.thread];
        return own;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own) const
    {
        (*this)(k, team, is_own, early(k, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own, const Early& own) const
    {
        Sums sums;
        int listed = 0, entry = own.entry;
        for (int first = own.begin; first < own.end; first += Team::kThreads) {
            const int e = first + team.thread;
            const bool acts = e < own.end && add(entry, sums);
            const auto flagged = team.flagged(acts);
            if (acts && is_own)
                acting.entries[own.begin + listed + flagged.before] = acting_entry(entry);
            listed += flagged.count;
            if (e + Team::kThreads < own.end)
                entry = touches.entries[e + Team::kThreads];
        }
        const Vec3 all = team_sum(team, sums.force);
        const Mat3 block = team_sum(team, sums.block);
        const double shares = team.sum(1, sums.energy);
        if (team.thread != 0 || !is_own)
            return;
        gradient[vertices[k]] += all;
        energy_shares[vertices[k]] += shares;
        blocks[k] = block;
        acting.count[k] = listed;
    }

private:
    struct Sums {
        Vec3 force{0.0, 0.0, 0.0};
        Mat3 block = Mat3::Zero();
        double energy = 0.0;
    };

    /// @return whether the term acts
    TOILE_HD bool add(int entry, Sums& sums) const
    {
        const int term = entry / 4, slot = entry % 4;
        const FrozenContact at = frozen[term];
        const Vec3 of_term = force[term];
        if (slot == 0)
            sums.energy += energy[term];
        const ContactPair& pair = touches.terms[term].pair;
        if (of_term != Vec3(0.0, 0.0, 0.0)) // most do not press
            sums.force += pair.weight[slot] * of_term;
        if (at.acts())
            sums.block += ContactTouches::bound_at(pair, slot, at);
        return at.acts();
    }

    TOILE_HD ActingEntry acting_entry(int entry) const
    {
        return ActingEntry::of(touches.terms[entry / 4].pair, entry % 4, frozen[entry / 4]);
    }
};

/// What the frozen terms at the vertex of list k answer to a move p of all. Every term is multiplied once for
/// each of its vertices: that takes less than a kernel before this one.
struct MultiplyList {
    ActingEntries acting;
    View<const PaddedVec3> p; ///< [vertices] [m]
    View<Vec3> product;       ///< [lists] out [N]

    /// Which entries a thread has, and the first of them.
    struct Early {
        int next, end;
        ActingEntry entry;
    };
    template <typename Team>
    TOILE_HD Early early(int k, const Team& team, bool /*is_own*/) const
    {
        Early own{acting.first[k] + team.thread, acting.first[k] + acting.count[k], {}};
        if (own.next < own.end)
            own.entry = acting.entries[own.next];
        return own;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own) const
    {
        (*this)(k, team, is_own, early(k, team, is_own));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_own, const Early& own) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        if (own.next < own.end)
            sum = own.entry.times(p);
        for (int e = own.next + Team::kThreads; e < own.end; e += Team::kThreads)
            sum += acting.entries[e].times(p);
        sum = team_sum(team, sum);
        if (team.thread == 0 && is_own)
            product[k] = sum;
    }
};

} // namespace toile
