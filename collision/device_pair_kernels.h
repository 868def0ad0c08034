#pragma once

/// How pairs with colliders are kept, dropped and listed by vertex on a GPU.

#include <cstdint>

#include "collision/collider_pairs_kernels.h"
#include "collision/contact_rules.h"
#include "collision/device_surface_kernels.h"

namespace toile {

/// The key of what belongs to no vertex: after all that do.
inline constexpr std::uint64_t kNoVertex = ~std::uint64_t(0);

/// Where vertices are and how far the farthest looks around, as a sum.
struct Surroundings {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::max()); ///< [m]
    Vec3 upper = -lower;                                             ///< [m]
    double reach = 0.0;                                              ///< [m]

    TOILE_HD Surroundings& operator+=(const Surroundings& other)
    {
        lower = lower.cwiseMin(other.lower);
        upper = upper.cwiseMax(other.upper);
        reach = std::max(reach, other.reach);
        return *this;
    }
};

/// ReachVertex, kept; the surroundings as a sum.
struct KeepReach {
    ReachVertex rule;
    View<double> reach, wanted; ///< [vertices] out [m]
    TOILE_HD Surroundings operator()(int v) const
    {
        reach[v] = wanted[v] = rule(v);
        return {rule.found_at[v], rule.found_at[v], reach[v]};
    }
};

/// Strays are looked for around where they are.
struct WantStray {
    View<const unsigned char> strays; ///< [vertices]
    View<const Vec3> x;               ///< [vertices] [m]
    double distance;                  ///< [m]
    View<Vec3> found_at;              ///< [vertices] in, out [m]
    View<double> reach, wanted;       ///< [vertices] in, out [m]
    TOILE_HD void operator()(int v) const
    {
        wanted[v] = kNowhere;
        if (strays[v] == 0)
            return;
        found_at[v] = x[v];
        wanted[v] = reach[v] = distance;
    }
};

/// A term of how many strays there are.
struct CountStray {
    View<const unsigned char> strays; ///< [vertices]
    TOILE_HD int operator()(int v) const { return strays[v]; }
};

/// Flags the pairs with meshes whose vertices have not strayed.
struct FlagKept {
    View<const ContactPair> pairs;
    View<const CarryingPartner> partners;
    View<const unsigned char> strays; ///< [vertices]
    View<unsigned char> flags;        ///< [pairs] out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[i];
        bool is_kept = partners[pair.collider].is_mesh;
        for (int k = 0; k < pair.count(); ++k)
            is_kept = is_kept && strays[pair.vertex[k]] == 0;
        flags[i] = is_kept ? 1 : 0;
    }
};

/// Copies the items that a list names.
template <typename T>
struct CopyListed {
    View<const T> from;
    View<const int> list;
    View<T> to;
    TOILE_HD void operator()(int i) const { to[i] = from[list[i]]; }
};

/// Copies all items.
template <typename T>
struct CopyItems {
    View<const T> from;
    View<T> to;
    TOILE_HD void operator()(int i) const { to[i] = from[i]; }
};

/// Planes of single vertices, those of a vertex side by side in the order of the pairs.
struct PlanesOfVertices {
    View<const ContactPair> pairs;
    View<const int> first;            ///< [vertices] place of its first plane and 1; 0: none
    View<const std::uint64_t> vertex; ///< [places]
    View<const int> pair;             ///< [places]

    /// True where place i is one of vertex v: those from first[v] - 1 on.
    TOILE_HD bool is_of(int i, int v) const { return i < vertex.size() && vertex[i] == std::uint64_t(v); }
};

struct KeyPlane {
    View<const ContactPair> pairs;
    View<std::uint64_t> keys; ///< [pairs] out
    View<int> values;         ///< [pairs] out
    TOILE_HD void operator()(int i) const
    {
        keys[i] = is_plane(pairs[i]) ? std::uint64_t(pairs[i].vertex[0]) : kNoVertex;
        values[i] = i;
    }
};

/// Tells vertices where their planes begin.
struct BeginPlanes {
    View<const std::uint64_t> keys; ///< [pairs] ascending
    View<int> first;                ///< [vertices] out, 0 elsewhere
    TOILE_HD void operator()(int i) const
    {
        if (keys[i] != kNoVertex && (i == 0 || keys[i - 1] != keys[i]))
            first[int(keys[i])] = i + 1;
    }
};

/// The surface nearest to a vertex.
struct TakeNearest {
    PlanesOfVertices planes;
    View<const Vec3> found_at;    ///< [vertices] [m]
    View<NearestSurface> nearest; ///< [vertices] out
    TOILE_HD void operator()(int v) const
    {
        NearestSurface best;
        if (planes.first[v] > 0)
            for (int i = planes.first[v] - 1; planes.is_of(i, v); ++i)
                best.consider(planes.pairs[planes.pair[i]], found_at);
        nearest[v] = best;
    }
};

} // namespace toile
