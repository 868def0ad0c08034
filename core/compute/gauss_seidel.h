#pragma once

/// Gauss-Seidel sweeps over items that share data, such as vertices. A GPU runs many items at once
/// (cuda/gauss_seidel.cuh), with the same bits as the CPU.

#include <array>
#include <cstdint>
#include <cstring>

#include "core/compute/types.h"

namespace toile {

/// Scattered order of items 0 to count - 1. Neighbours in a list often share data, so that in list order each
/// item would wait for the one before it. The items of a group of 32 belong to 32 different classes, by
/// hashing. Classes run one after the other, the items of a class in list order.
struct GaussSeidelSchedule {
    static constexpr int kClasses = 32;

    int count = 0;

    TOILE_HD int groups() const { return count / kClasses + (count % kClasses != 0 ? 1 : 0); }

    /// Number of slots in the order; the last slot of a class may be empty.
    TOILE_HD int slot_count() const { return kClasses * groups(); }

    TOILE_HD int class_of(int item) const
    {
        return (kStep * (item % kClasses) + group_offset(item / kClasses)) % kClasses;
    }
    TOILE_HD int slot_of(int item) const { return class_of(item) * groups() + item / kClasses; }

    /// Item at a slot; count or more for an empty slot.
    TOILE_HD int at(int slot) const
    {
        const int group = slot % groups(), of_class = slot / groups();
        return kClasses * group + kBack * (of_class + kClasses - group_offset(group)) % kClasses;
    }

private:
    /// Difference of the classes of neighbouring items, odd, and its inverse modulo kClasses.
    static constexpr int kStep = 13, kBack = 5;
    static_assert(kStep * kBack % kClasses == 1);

    /// Class of a group's first item, by Fibonacci hashing.
    TOILE_HD static int group_offset(int group) { return int((std::uint32_t(group) * 2654435769U) >> 27); }
};

/// Vector with a version, passed between items on a GPU in two words that are read and written atomically. A
/// reader that finds the expected version in both words has the vector too, and needs no fence.
struct TaggedVector {
    struct alignas(16) Word {
        std::uint64_t number;           ///< x or y
        std::uint64_t part_and_version; ///< half of z in the upper bits, the version in the lower ones
    };
    Word words[2];

    TaggedVector() = default;
    TOILE_HD TaggedVector(const Vec3& value, int version)
    {
        const std::uint64_t z = bits_of(value[2]);
        words[0] = {bits_of(value[0]), (z & kUpper) | std::uint32_t(version)};
        words[1] = {bits_of(value[1]), z << 32 | std::uint32_t(version)};
    }

    TOILE_HD Vec3 value() const
    {
        const std::uint64_t z = (words[0].part_and_version & kUpper) | words[1].part_and_version >> 32;
        return {number_of(words[0].number), number_of(words[1].number), number_of(z)};
    }

    /// Version of both words if they agree, or else the older one.
    TOILE_HD int version() const
    {
        const int first = int(std::uint32_t(words[0].part_and_version)),
                  second = int(std::uint32_t(words[1].part_and_version));
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

/// Rank of an item among the listed items that share a datum.
class GaussSeidelRank {
public:
    GaussSeidelRank() = default;
    TOILE_HD GaussSeidelRank(int before, bool is_last) : code_(2 * before + (is_last ? 1 : 0)) {}

    TOILE_HD int before() const { return code_ / 2; } ///< number of items before it
    TOILE_HD bool is_last() const { return code_ % 2 != 0; }

private:
    int code_;
};

/// State of a Gauss-Seidel sweep on a GPU over the listed items of a schedule. An item shares up to
/// kSharedSlots different data, such as vertices, with others.
struct GaussSeidelState {
    static constexpr int kSharedSlots = 4;

    GaussSeidelSchedule order;
    View<const int> slots;            ///< of listed items, ascending: the first count[0]
    View<const int> count;            ///< [1]
    View<const GaussSeidelRank> rank; ///< [kSharedSlots x items] for each datum of an item
    View<TaggedVector> passed;        ///< [fields x shared] values from the item before
    View<unsigned> next;              ///< [1] visits that have begun
};

/// Vectors of all shared data, one per datum and field.
template <int kFields>
using SharedFields = std::array<View<Vec3>, kFields>;

/// Vectors of the data that one item shares, per field.
template <int kFields>
using LocalFields = std::array<std::array<Vec3, GaussSeidelState::kSharedSlots>, kFields>;

/// Items by shared datum: the entries of list k are kSharedSlots * item + slot, ascending.
struct SharedLists {
    View<const int> list_of; ///< [shared] number of each datum's list, from 1 on
    View<const int> first;   ///< [lists + 1] into entries
    View<const int> entries;
};

/// Ranks the listed items for each datum that they share, and initialises the vectors of the first item of
/// each. Thread q does datum q % kSharedSlots of the item at slots[q / kSharedSlots]. Writes rank and the
/// listed part of state.passed.
/// @tparam SharedBy  item -> its shared data, as GaussSeidelState::kSharedSlots numbers; -1 unused
template <typename SharedBy, int kFields>
struct AssignGaussSeidelRank {
    GaussSeidelState state;
    SharedBy shared_by;
    View<const unsigned char> listed; ///< [slots] 1 where an item is listed
    SharedLists lists;
    SharedFields<kFields> fields;
    View<GaussSeidelRank> rank; ///< out, see GaussSeidelState

    TOILE_HD void operator()(int q) const
    {
        if (q / GaussSeidelState::kSharedSlots >= state.count[0])
            return;
        const int self = state.slots[q / GaussSeidelState::kSharedSlots];
        const int entry =
            GaussSeidelState::kSharedSlots * state.order.at(self) + q % GaussSeidelState::kSharedSlots;
        const int shared =
            shared_by(entry / GaussSeidelState::kSharedSlots)[entry % GaussSeidelState::kSharedSlots];
        if (shared < 0)
            return;
        const int list = lists.list_of[shared] - 1;
        int before = 0, after = 0;
        for (int e = lists.first[list]; e < lists.first[list + 1]; ++e) {
            const int slot = state.order.slot_of(lists.entries[e] / GaussSeidelState::kSharedSlots);
            (slot < self ? before : after) += listed[slot];
        }
        rank[entry] = GaussSeidelRank(before, after == 1); // `after` counts the item itself
        if (before > 0)
            return;
        for (int f = 0; f < kFields; ++f)
            state.passed[f * fields[f].size() + shared] = TaggedVector(fields[f][shared], 0);
    }
};

} // namespace toile
