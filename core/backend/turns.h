#pragma once

/// Items that change what they share with others, one after the other: Gauss-Seidel sweeps that a GPU does
/// with many at once (cuda/turns.cuh), to the same bits as the CPU.

#include <array>
#include <cstdint>
#include <cstring>

#include "core/backend/types.h"

namespace toile {

/// A scattered order of items 0 to count - 1. Neighbours in a list often share something, as do those of
/// neighbouring vertices: in the list's own order each would wait for the one before it. Of every 32
/// that follow each other each goes in another of 32 classes, by lot; the classes take turns, and the items
/// of one go as they are listed.
struct TurnOrder {
    static constexpr int kClasses = 32;

    int count = 0;

    TOILE_HD int groups() const { return count / kClasses + (count % kClasses != 0 ? 1 : 0); }

    /// Places in the order; some of the last of a class are empty.
    TOILE_HD int place_count() const { return kClasses * groups(); }

    TOILE_HD int class_of(int item) const
    {
        return (kStep * (item % kClasses) + lot(item / kClasses)) % kClasses;
    }
    TOILE_HD int place_of(int item) const { return class_of(item) * groups() + item / kClasses; }

    /// The item at a place; count or more at an empty one.
    TOILE_HD int at(int place) const
    {
        const int group = place % groups(), of_class = place / groups();
        return kClasses * group + kBack * (of_class + kClasses - lot(group)) % kClasses;
    }

private:
    /// From class to class of neighbours, odd; and what undoes it.
    static constexpr int kStep = 13, kBack = 5;
    static_assert(kStep * kBack % kClasses == 1);

    /// Where a group begins: Fibonacci hashing.
    TOILE_HD static int lot(int group) { return int((std::uint32_t(group) * 2654435769U) >> 27); }
};

/// A vector that one turn leaves to the next on a GPU: two words that are each read and written whole, either
/// of them with how many turns there have been. Who finds the number that it waits for in both has the vector
/// too, and needs no fence.
struct TaggedVector {
    struct alignas(16) Word {
        std::uint64_t number;         ///< x, or y
        std::uint64_t part_and_turns; ///< half of z above, the turns below
    };
    Word words[2];

    TaggedVector() = default;
    TOILE_HD TaggedVector(const Vec3& value, int turns)
    {
        const std::uint64_t z = bits_of(value[2]);
        words[0] = {bits_of(value[0]), (z & kUpper) | std::uint32_t(turns)};
        words[1] = {bits_of(value[1]), z << 32 | std::uint32_t(turns)};
    }

    TOILE_HD Vec3 value() const
    {
        const std::uint64_t z = (words[0].part_and_turns & kUpper) | words[1].part_and_turns >> 32;
        return {number_of(words[0].number), number_of(words[1].number), number_of(z)};
    }

    /// Of both words where they agree, or else of the older.
    TOILE_HD int turns() const
    {
        const int first = int(std::uint32_t(words[0].part_and_turns)),
                  second = int(std::uint32_t(words[1].part_and_turns));
        return first < second ? first : second;
    }

private:
    static constexpr std::uint64_t kUpper = 0xffffffff00000000U;

    TOILE_HD static std::uint64_t bits_of(double number)
    {
        std::uint64_t bits;
        memcpy(&bits, &number, sizeof(bits));
        return bits;
    }
    TOILE_HD static double number_of(std::uint64_t bits)
    {
        double number;
        memcpy(&number, &bits, sizeof(number));
        return number;
    }
};

/// Where an item comes among those that share a thing.
class TurnRank {
public:
    TurnRank() = default;
    TOILE_HD TurnRank(int before, bool is_last) : code_(2 * before + (is_last ? 1 : 0)) {}

    TOILE_HD int before() const { return code_ / 2; } ///< how many come before it
    TOILE_HD bool is_last() const { return code_ % 2 != 0; }

private:
    int code_;
};

/// Whose turn it is on a GPU: of items that are listed in a TurnOrder and share up to four different things,
/// such as vertices, with others.
struct Turns {
    static constexpr int kShares = 4;

    TurnOrder order;
    View<const int> places;    ///< of listed items, ascending: the first count[0]
    View<const int> count;     ///< [1]
    View<const TurnRank> rank; ///< [kShares x items] in each thing that it shares
    View<TaggedVector> passed; ///< [fields x shared] what those left that have had their turn
    View<unsigned> next;       ///< [1] visits that have begun
};

/// What is shared: of each thing a vector of each field.
template <int kFields>
using SharedFields = std::array<View<Vec3>, kFields>;

/// The same of what one item shares.
template <int kFields>
using OwnFields = std::array<std::array<Vec3, Turns::kShares>, kFields>;

/// Who shares what: the entries of list k are kShares * item + slot, ascending.
struct SharedLists {
    View<const int> list_of; ///< [shared] number of the list of each, from 1 on
    View<const int> first;   ///< [lists + 1] into entries
    View<const int> entries;
};

/// Numbers the listed items in what they share, and lays out for the first of them what it begins with:
/// thread q the q % kShares-th of item places[q / kShares]. Out: rank, and turns.passed of what is listed.
/// @tparam SharedBy  item -> what it shares, as Turns::kShares numbers; -1 unused
template <typename SharedBy, int kFields>
struct NumberTurn {
    Turns turns;
    SharedBy shared_by;
    View<const unsigned char> listed; ///< [places] 1 where an item is listed
    SharedLists lists;
    SharedFields<kFields> fields;
    View<TurnRank> rank; ///< out, see Turns

    TOILE_HD void operator()(int q) const
    {
        if (q / Turns::kShares >= turns.count[0])
            return;
        const int own = turns.places[q / Turns::kShares];
        const int entry = Turns::kShares * turns.order.at(own) + q % Turns::kShares;
        const int shared = shared_by(entry / Turns::kShares)[entry % Turns::kShares];
        if (shared < 0)
            return;
        const int list = lists.list_of[shared] - 1;
        int before = 0, after = 0;
        for (int e = lists.first[list]; e < lists.first[list + 1]; ++e) {
            const int place = turns.order.place_of(lists.entries[e] / Turns::kShares);
            (place < own ? before : after) += listed[place];
        }
        rank[entry] = TurnRank(before, after == 1); // itself
        if (before > 0)
            return;
        for (int f = 0; f < kFields; ++f)
            turns.passed[f * fields[f].size() + shared] = TaggedVector(fields[f][shared], 0);
    }
};

} // namespace toile
