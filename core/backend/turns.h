#pragma once

/// Items that change what they share with others, one after the other: Gauss-Seidel sweeps that a GPU does
/// with many at once (cuda/turns.cuh), to the same bits as the CPU.

#include <array>
#include <cstdint>

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

/// Whose turn it is on a GPU: of items that are listed in a TurnOrder and share up to four of something, such
/// as vertices, with others.
struct Turns {
    static constexpr int kShares = 4;

    TurnOrder order;
    View<const int> places; ///< of listed items, ascending: the first count[0]
    View<const int> count;  ///< [1]
    View<const int> rank;   ///< [kShares x items] how many come before it in what it shares
    View<int> served;       ///< [shared] how many have come
    View<unsigned> next;    ///< [1] visits that have begun
};

/// Numbers those that share something: list k of the items that do.
struct NumberTurns {
    TurnOrder order;
    View<const unsigned char> listed; ///< [places] 1 where an item is listed
    View<const int> of;               ///< [lists] what is shared
    View<const int> first;            ///< [lists + 1] into entries
    View<const int> entries;          ///< kShares * item + slot, ascending in each list
    View<int> rank, served;           ///< out, see Turns

    TOILE_HD void operator()(int k) const
    {
        std::array<int, TurnOrder::kClasses> next{};
        for (int e = first[k]; e < first[k + 1]; ++e)
            if (is_listed(entries[e]))
                ++next[class_of(entries[e])];
        int sum = 0;
        for (int& of_class : next) {
            const int size = of_class;
            of_class = sum;
            sum += size;
        }
        for (int e = first[k]; e < first[k + 1]; ++e)
            if (is_listed(entries[e]))
                rank[entries[e]] = next[class_of(entries[e])]++;
        served[of[k]] = 0;
    }

private:
    TOILE_HD int class_of(int entry) const { return order.class_of(entry / Turns::kShares); }
    TOILE_HD bool is_listed(int entry) const { return listed[order.place_of(entry / Turns::kShares)] != 0; }
};

} // namespace toile
