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

/// Whose turn it is on a GPU: of items that are listed in a TurnOrder and share up to four different things,
/// such as vertices, with others.
struct Turns {
    static constexpr int kShares = 4;

    TurnOrder order;
    View<const int> places; ///< of listed items, ascending: the first count[0]
    View<const int> count;  ///< [1]
    View<const int> rank;   ///< [kShares x items] how many come before it in what it shares
    View<int> served;       ///< [shared] how many have come
    View<unsigned> next;    ///< [1] visits that have begun
};

/// Who shares what: the entries of list k are kShares * item + slot, ascending.
struct SharedLists {
    View<const int> list_of; ///< [shared] number of the list of each, from 1 on
    View<const int> first;   ///< [lists + 1] into entries
    View<const int> entries;
};

/// Numbers the listed items in what they share: thread q the q % kShares-th of item places[q / kShares].
/// @tparam SharedBy  item -> what it shares, as Turns::kShares numbers; -1 unused
template <typename SharedBy>
struct NumberTurn {
    Turns turns;
    SharedBy shared_by;
    View<const unsigned char> listed; ///< [places] 1 where an item is listed
    SharedLists lists;
    View<int> rank; ///< out, see Turns

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
        int before = 0;
        for (int e = lists.first[list]; e < lists.first[list + 1]; ++e)
            if (const int place = turns.order.place_of(lists.entries[e] / Turns::kShares); place < own)
                before += listed[place];
        rank[entry] = before;
        turns.served[shared] = 0;
    }
};

} // namespace toile
