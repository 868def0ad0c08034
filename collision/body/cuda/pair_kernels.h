#pragma once

/// Kernels that keep, drop and list collider pairs by vertex on a GPU.

#include <cstdint>

#include "collision/body/collider_pairs_kernels.h"
#include "collision/geometry/cuda/surface_kernels.h"

namespace toile::collision {

/// Key of pairs that are no vertex planes, above the keys of all vertices.
inline constexpr std::uint64_t kNoVertex = ~std::uint64_t(0);

/// Bounds of vertices and the maximum of their search radii of shapes, as a sum.
struct QueryBounds {
    Vec3 lower = Vec3::Constant(std::numeric_limits<double>::max()); ///< [m]
    Vec3 upper = -lower;                                             ///< [m]
    double reach = 0.0;                                              ///< [m]

    TOILE_HD QueryBounds& operator+=(const QueryBounds& other)
    {
        lower = lower.cwiseMin(other.lower);
        upper = upper.cwiseMax(other.upper);
        reach = std::max(reach, other.reach);
        return *this;
    }
};

/// Writes ReachVertex; returns the vertex's bounds and radius as a summand.
struct KeepReach {
    ReachVertex rule;
    View<double> reach, wanted; ///< [vertices] out [m]
    TOILE_HD QueryBounds operator()(int v) const
    {
        reach[v] = wanted[v] = rule(v);
        return {rule.found_at[v], rule.found_at[v], rule.shape_reach(v)};
    }
};

/// Centres the search of out-of-bounds vertices at their current positions.
struct QueryOutOfBounds {
    View<const unsigned char> out_of_bounds; ///< [vertices]
    View<const Vec3> x;                      ///< [vertices] [m]
    double distance;                         ///< [m]
    View<Vec3> found_at;                     ///< [vertices] in, out [m]
    View<double> reach, wanted;              ///< [vertices] in, out [m]
    TOILE_HD void operator()(int v) const
    {
        wanted[v] = kNowhere;
        if (out_of_bounds[v] == 0)
            return;
        found_at[v] = x[v];
        wanted[v] = reach[v] = distance;
    }
};

/// Summand of the number of out-of-bounds vertices.
struct CountOutOfBounds {
    View<const unsigned char> out_of_bounds; ///< [vertices]
    TOILE_HD int operator()(int v) const { return out_of_bounds[v]; }
};

/// Flags the pairs with meshes whose vertices are all within bounds.
struct FlagKept {
    View<const ContactPair> pairs;
    View<const AdvectingCollider> colliders;
    View<const unsigned char> out_of_bounds; ///< [vertices]
    View<unsigned char> flags;               ///< [pairs] out
    TOILE_HD void operator()(int i) const
    {
        const ContactPair& pair = pairs[i];
        bool is_kept = colliders[pair.collider].is_mesh;
        for (int k = 0; k < pair.count(); ++k)
            is_kept = is_kept && out_of_bounds[pair.vertex[k]] == 0;
        flags[i] = is_kept ? 1 : 0;
    }
};

/// Copies the listed items.
template <typename T>
struct CopyListed {
    View<const T> from;
    View<const int> list;
    View<T> to;
    TOILE_HD void operator()(int i) const { to[i] = from[list[i]]; }
};

/// Planes of single vertices, grouped by vertex in the order of the pairs.
struct PlanesOfVertices {
    View<const ContactPair> pairs;
    View<const int> first;            ///< [vertices] index of its first slot, plus 1; 0: none
    View<const std::uint64_t> vertex; ///< [slots]
    View<const int> pair;             ///< [slots]

    /// True if slot i belongs to vertex v; its slots begin at first[v] - 1.
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

/// Writes the first slot of each vertex's planes.
struct BeginPlanes {
    View<const std::uint64_t> keys; ///< [pairs] ascending
    View<int> first;                ///< [vertices] out, 0 elsewhere
    TOILE_HD void operator()(int i) const
    {
        if (keys[i] != kNoVertex && (i == 0 || keys[i - 1] != keys[i]))
            first[int(keys[i])] = i + 1;
    }
};

/// Finds the surface nearest to a vertex.
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

} // namespace toile::collision
