#pragma once

/// Kernels that make terms on a GPU, list them by vertex and store their memory, and kernels of the energy.

#include <cstdint>

#include "collision/body/cuda/pair_kernels.h"
#include "collision/contact/kernels.h"
#include "collision/contact/memory.h"
#include "collision/contact/rules.h"
#include "core/compute/lanes.h"
#include "core/pd/cuda/active_set.h"

namespace toile::collision {

/// Hash of a record's key [Steele et al. 2014, SplitMix64].
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

/// Stored records, by their hashes.
struct KnownContacts {
    View<const std::uint64_t> hashes; ///< [records] ascending
    View<const int> order;            ///< [records] of these hashes; ascending for equal hashes
    View<const ContactRecord> records;

    /// See ContactMemory::warm_start.
    TOILE_HD void warm_start(ContactTerm& term) const
    {
        WarmStart start{term};
        const std::uint64_t hash = hash_of(start.key);
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
            if (const ContactRecord& record = records[order[i]]; record.has_key_of(start.key))
                start.consider(record);
    }
};

/// Flags the terms that press.
struct FlagPressing {
    View<const ContactTerm> terms;
    View<unsigned char> flags; ///< [terms] out
    TOILE_HD void operator()(int i) const { flags[i] = terms[i].has_pressed() ? 1 : 0; }
};

/// Stores record i, of a term that presses.
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

/// Half of the clearance between each plane of a vertex and the nearest opposing one
/// (HostContactTerms::clearance_of_planes), and the minimum of each vertex.
struct FindOpposingClearance {
    PlanesOfVertices planes;
    View<const Vec3> found_at; ///< [vertices] [m]
    View<double> clearance;    ///< [pairs] out, of planes [m]
    View<double> overlap;      ///< [vertices] out: their minimum if that is negative, else 0 [m]

    TOILE_HD void operator()(int v) const
    {
        double min_clearance = 0.0;
        const int first = planes.first[v] - 1;
        for (int a = first; a >= 0 && planes.is_of(a, v); ++a) {
            const ContactPair& pair = planes.pairs[planes.pair[a]];
            double pair_clearance = std::numeric_limits<double>::infinity();
            for (int b = first; planes.is_of(b, v); ++b) {
                const ContactPair& other = planes.pairs[planes.pair[b]];
                if (a == b || !are_opposing(pair, other))
                    continue;
                const double half = half_clearance(pair, other, found_at);
                pair_clearance = half < pair_clearance ? half : pair_clearance;
            }
            clearance[planes.pair[a]] = pair_clearance;
            min_clearance = pair_clearance < min_clearance ? pair_clearance : min_clearance;
        }
        overlap[v] = min_clearance;
    }
};

/// Pairs with colliders, then those of a ClothContact.
struct ConcatenatedPairs {
    View<const ContactPair> first, second;
    TOILE_HD const ContactPair& operator[](int i) const
    {
        return i < first.size() ? first[i] : second[i - first.size()];
    }
};

/// Flags the pairs that become terms: see ContactTerms::make.
struct FlagTerm {
    ConcatenatedPairs pairs;
    ContactRules rules;
    View<const double> overlap;   ///< [vertices] see FindOpposingClearance [m]
    View<const double> clearance; ///< [pairs with colliders] likewise
    ReplacedPairs replaced;
    View<unsigned char> flags; ///< [pairs] out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[i];
        bool is_caught = false;
        for (int k = 0; k < pair.count() && pair.kind < ContactKind::kGuard && !is_plane(pair); ++k)
            is_caught = is_caught || overlap[pair.vertex[k]] < 0.0;
        const double room = is_plane(pair) ? clearance[i] : std::numeric_limits<double>::infinity();
        flags[i] = !is_caught && !rules.is_fixed(pair) && !replaced(pair, room) ? 1 : 0;
    }
};

/// Makes term i.
struct MakeTerm {
    ConcatenatedPairs pairs;
    ContactRules rules;
    View<const double> clearance; ///< [pairs with colliders] see FindOpposingClearance [m]
    ReplacedPairs replaced;
    KnownContacts known;
    View<const int> list;    ///< [terms] pairs
    View<ContactTerm> terms; ///< out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[list[i]];
        ContactTerm term =
            rules.term_of(pair, is_plane(pair) ? clearance[list[i]] : std::numeric_limits<double>::infinity(),
                          replaced.pinched(pair));
        known.warm_start(term);
        terms[i] = term;
    }
};

/// Writes the vertices of terms as keys, and their entries (see ContactIncidence).
struct KeyIncidence {
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

/// Flags the begin of each vertex's list, and the end of the last one.
struct FlagLists {
    View<const std::uint64_t> keys; ///< [4 x terms] ascending
    View<unsigned char> flags;      ///< [4 x terms + 1] out
    TOILE_HD void operator()(int e) const
    {
        const std::uint64_t key = e < keys.size() ? keys[e] : kNoVertex;
        flags[e] = e == 0 || keys[e - 1] != key ? 1 : 0;
    }
};

/// Writes the vertex of list k, and the list of that vertex.
struct NumberList {
    View<const int> first;          ///< [lists]
    View<const std::uint64_t> keys; ///< [4 x terms]
    View<int> vertices;             ///< [lists] out
    View<int> list_of;              ///< [vertices] out: k + 1; 0 without a list
    TOILE_HD void operator()(int k) const
    {
        vertices[k] = int(keys[first[k]]);
        list_of[vertices[k]] = k + 1;
    }
};

/// Sum over the threads of a team: a vertex may be in many terms, and a kernel lasts as long as its longest
/// list.
template <typename Team, typename Numbers>
TOILE_HD Numbers team_sum(const Team& team, Numbers local)
{
    for (int k = 0; k < int(local.size()); ++k)
        local.data()[k] = team.sum(1, local.data()[k]);
    return local;
}

/// Evaluates and freezes a term.
struct EvaluateAndFreeze {
    EvaluateContact evaluate;
    FreezeContact freeze;
    /// Loads the term, which does not change; only its vertices move.
    TOILE_HD ContactTerm prologue(int i) const { return evaluate.terms[i]; }

    TOILE_HD void operator()(int i) const { (*this)(i, prologue(i)); }
    TOILE_HD void operator()(int i, const ContactTerm& term) const
    {
        evaluate(i, term);
        freeze(i, term);
    }
};

/// Adds the forces on the vertex of list k, and the energies of the terms whose first vertex it is. Bounds
/// their frozen Hessian, and lists the active ones.
struct GatherContact {
    ContactIncidence incidence;
    View<const int> vertices;         ///< [lists]
    View<const Vec3> force;           ///< [terms] [N]
    View<const double> energy;        ///< [terms] [J]
    View<const FrozenContact> frozen; ///< [terms]
    View<Vec3> gradient;              ///< [vertices] added to [N]
    View<double> vertex_energy;       ///< [vertices] added to [J]
    View<Mat3> blocks;                ///< [lists] out [N/m]
    FrozenRows rows;                  ///< out

    /// Entries of the list, and the first one of the thread.
    struct Prologue {
        int begin, end, entry;
    };
    template <typename Team>
    TOILE_HD Prologue prologue(int k, const Team& team, bool /*is_in_range*/) const
    {
        Prologue local{incidence.first[k], incidence.first[k + 1], 0};
        if (local.begin + team.thread < local.end)
            local.entry = incidence.entries[local.begin + team.thread];
        return local;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range) const
    {
        (*this)(k, team, is_in_range, prologue(k, team, is_in_range));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range, const Prologue& local) const
    {
        Sums sums;
        int listed = 0, entry = local.entry;
        for (int first = local.begin; first < local.end; first += Team::kThreads) {
            const int e = first + team.thread;
            const bool is_active = e < local.end && add(entry, sums);
            const auto flagged = team.flagged(is_active);
            if (is_active && is_in_range)
                rows.rows[local.begin + listed + flagged.before] = row_of(entry);
            listed += flagged.count;
            if (e + Team::kThreads < local.end)
                entry = incidence.entries[e + Team::kThreads];
        }
        const Vec3 all = team_sum(team, sums.force);
        const Mat3 block = team_sum(team, sums.block);
        const double energy_sum = team.sum(1, sums.energy);
        if (team.thread != 0 || !is_in_range)
            return;
        gradient[vertices[k]] += all;
        vertex_energy[vertices[k]] += energy_sum;
        blocks[k] = block;
        rows.active_count[k] = listed;
    }

private:
    struct Sums {
        Vec3 force{0.0, 0.0, 0.0};
        Mat3 block = Mat3::Zero();
        double energy = 0.0;
    };

    /// @return whether the term is active
    TOILE_HD bool add(int entry, Sums& sums) const
    {
        const int term = entry / 4, slot = entry % 4;
        const FrozenContact at = frozen[term];
        const Vec3 of_term = force[term];
        if (slot == 0)
            sums.energy += energy[term];
        const ContactPair& pair = incidence.terms[term].pair;
        if (of_term != Vec3(0.0, 0.0, 0.0)) // the majority does not press
            sums.force += pair.weight[slot] * of_term;
        if (at.is_active())
            sums.block += ContactIncidence::bound_at(pair, slot, at);
        return at.is_active();
    }

    TOILE_HD FrozenRow row_of(int entry) const
    {
        const ContactPair& pair = incidence.terms[entry / 4].pair;
        return FrozenRow::of(pair.vertex, pair.weight, entry % 4, frozen[entry / 4].matrix(pair.normal));
    }
};

/// Product of the frozen terms at the vertex of list k with a move p of all vertices. Every term is
/// multiplied once for each of its vertices, which takes less time than another kernel before this one.
struct MultiplyList {
    FrozenRows rows;
    View<const PaddedVec3> p; ///< [vertices] [m]
    View<Vec3> product;       ///< [lists] out [N]

    /// Entries of the thread, and the first of them.
    struct Prologue {
        int next, end;
        FrozenRow entry;
    };
    template <typename Team>
    TOILE_HD Prologue prologue(int k, const Team& team, bool /*is_in_range*/) const
    {
        Prologue local{rows.first[k] + team.thread, rows.first[k] + rows.active_count[k], {}};
        if (local.next < local.end)
            local.entry = rows.rows[local.next];
        return local;
    }

    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range) const
    {
        (*this)(k, team, is_in_range, prologue(k, team, is_in_range));
    }
    template <typename Team>
    TOILE_HD void operator()(int k, const Team& team, bool is_in_range, const Prologue& local) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        if (local.next < local.end)
            sum = local.entry.times(p);
        for (int e = local.next + Team::kThreads; e < local.end; e += Team::kThreads)
            sum += rows.rows[e].times(p);
        sum = team_sum(team, sum);
        if (team.thread == 0 && is_in_range)
            product[k] = sum;
    }
};

} // namespace toile::collision
