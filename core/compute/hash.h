#pragma once

#include <compare>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/compute/types.h"

namespace toile {

/// Fingerprint of content: two contents collide by accident once in 2^128 pairs. No protection against
/// constructed collisions.
struct Hash128 {
    std::uint64_t high = 0, low = 0;

    auto operator<=>(const Hash128&) const = default; // NOLINT(modernize-use-nullptr): means the 0 inside
};

/// 32 hexadecimal digits.
std::string to_hex(const Hash128& hash);

/// Hashes a sequence of plain values by their bytes [XXH3, Collet 2019]. The hash does not depend on how the
/// values are split into add() calls; add sizes where that is ambiguous.
class Hasher {
public:
    Hasher();
    ~Hasher();
    Hasher(const Hasher&) = delete;
    Hasher& operator=(const Hasher&) = delete;

    void add_bytes(const void* data, size_t size);

    template <typename T>
    void add(const T& value)
    {
        static_assert(std::has_unique_object_representations_v<T> || std::is_floating_point_v<T>,
                      "padding has no fixed bytes");
        add_bytes(&value, sizeof value);
    }

    /// Adds size and items. Vectors of Eigen's plain matrices have no padding either.
    template <typename T>
    void add(View<const T> values)
    {
        add(values.size());
        add_bytes(values.data(), size_t(values.size()) * sizeof(T));
    }
    void add(std::string_view text)
    {
        add(text.size());
        add_bytes(text.data(), text.size());
    }

    Hash128 result() const;

private:
    struct State;
    std::unique_ptr<State> state_;
};

} // namespace toile
