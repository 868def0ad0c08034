#pragma once

#include <algorithm>
#include <utility>
#include <vector>

#include "collision/self/pair_rules.h"

namespace toile::collision {

/// A surface that faces within this cosine of the owner's normal is the owner's own [-]; all others pass.
inline constexpr double kOwnSheet = 0.3;

/// Which surfaces pass through a vertex of cloth: those that oppose its owner, or all. See LetThrough.
inline constexpr unsigned char kLetsOpposing = 1, kLetsAll = 2;

/// A vertex of cloth and one of a body, of triangles that cross.
using BodyCrossing = std::pair<int, int>;

/// ExemptPairs for kernels: borrowed fields of host or device.
struct ExemptRule {
    View<const Vec3> rest;             ///< [vertices] [m]
    double too_near;                   ///< [m]
    View<const unsigned char> is_thin; ///< [vertices] around a sliver
    View<const unsigned char> crosses; ///< [vertices] of triangles of cloth that cross

    // Cloth that crosses bodies.
    View<const BodyCrossing> body_crossings = {}; ///< ascending
    View<const unsigned char> inside = {};        ///< [cloth] see ExemptPairs; empty: none is

    // Bodies that cloth lets through: see LetThrough.
    View<const unsigned char> lets_through = {}; ///< [cloth] empty: no cloth does
    View<const Vec3> owner_normal = {};          ///< [cloth] unit
    View<const Vec3> body_normal = {};           ///< [bodies] unit

    TOILE_HD bool is_exempt(const NearPair& pair) const
    {
        const int first = first_count(pair.is_edge_edge);
        bool crossing[2] = {false, false};
        bool is_near_sliver = false;
        for (int k = 0; k < 4; ++k) {
            bool& side = crossing[k < first ? 0 : 1];
            side = side || crosses[pair.vertex[k]];
            is_near_sliver = is_near_sliver || is_thin[pair.vertex[k]];
        }
        return (crossing[0] && crossing[1]) || (is_near_sliver && is_sliver_pair(pair)) ||
               crosses_body(pair) || is_let_through(pair);
    }

private:
    /// True if the pair has vertices of two triangles that cross, or cloth inside a body.
    TOILE_HD bool crosses_body(const NearPair& pair) const
    {
        if (body_crossings.empty() && inside.empty())
            return false;
        const int cloth = inside.size();
        const bool has_body = is_with_body(pair, cloth);
        for (const int v : pair.vertex)
            if (has_body && v < cloth && inside[v] != 0)
                return true;
        const int first = first_count(pair.is_edge_edge);
        for (int a = 0; a < first; ++a)
            for (int b = first; b < 4; ++b)
                if (have_crossed(std::min(pair.vertex[a], pair.vertex[b]),
                                 std::max(pair.vertex[a], pair.vertex[b])))
                    return true;
        return false;
    }
    TOILE_HD bool have_crossed(int cloth, int body) const
    {
        int first = 0, end = body_crossings.size();
        while (first < end) {
            const int middle = first + (end - first) / 2;
            const BodyCrossing& at = body_crossings[middle];
            if (at.first == cloth && at.second == body)
                return true;
            if (at.first < cloth || (at.first == cloth && at.second < body))
                first = middle + 1;
            else
                end = middle;
        }
        return false;
    }
    TOILE_HD bool is_let_through(const NearPair& pair) const
    {
        if (lets_through.empty())
            return false;
        const int cloth = lets_through.size();
        if (!is_with_body(pair, cloth))
            return false;
        Vec3 normal = Vec3::Zero();
        for (const int v : pair.vertex)
            if (v >= cloth)
                normal += body_normal[v - cloth];
        for (const int v : pair.vertex)
            if (v < cloth &&
                (lets_through[v] == kLetsAll || (lets_through[v] == kLetsOpposing &&
                                                 owner_normal[v].dot(normal) < kOwnSheet * normal.norm())))
                return true;
        return false;
    }
    TOILE_HD bool is_sliver_pair(const NearPair& pair) const
    {
        const std::array<Vec3, 4> x = corners_of(pair.vertex, rest);
        return closest_difference(closest_weights(pair.is_edge_edge, x), x).norm() < too_near;
    }
};

/// Pairs that contact of cloth with cloth ignores, because it could only do harm:
///
/// - Cloth that crosses cloth or a body already (a start pose that could not be repaired, cloth that was
///   moved, body parts that close on it): contact would keep it on the wrong side. Pairs with vertices of
///   crossing triangles on both sides are exempt until these triangles no longer cross. All other pairs are
///   kept apart, so crossings can move, shrink and vanish, but none begins elsewhere.
/// - Cloth that is caught between two surfaces of bodies and lets one of them through (LetThrough).
/// - Neighbours around slivers in one cloth that are closer in the start pose than a multiple of the minimum
///   gap.
class ExemptPairs {
public:
    /// @param rest       [vertices] start positions [m]
    /// @param altitude   [vertices] shortest altitude of the adjacent triangles [m]
    /// @param min_gap  [m] see CollisionFreeStep
    ExemptPairs(View<const Vec3> rest, View<const double> altitude, double min_gap);

    /// @param crosses  [vertices] 1 for the corners of triangles of cloth that cross others; initially none
    void set_crossing(View<const unsigned char> crosses);
    void set_body_crossings(std::vector<BodyCrossing> crossings);
    /// @param inside  [cloth] 1: inside a body, which it has to leave; all others are of bodies
    void set_inside(View<const unsigned char> inside);
    void add_body_crossings(View<const BodyCrossing> more);

    /// Sets the bodies that cloth lets through; borrowed. See ExemptRule.
    void set_let_through(View<const unsigned char> lets_through, View<const Vec3> owner_normal,
                         View<const Vec3> body_normal);

    bool is_exempt(const NearPair& pair) const { return rule().is_exempt(pair); }
    ExemptRule rule() const
    {
        return {rest_,   too_near_,     is_thin_,      crosses_,    body_crossings_,
                inside_, lets_through_, owner_normal_, body_normal_};
    }

    /// Number of changes so far, for copies of the rule.
    int revision() const { return revision_; }

private:
    std::vector<Vec3> rest_;
    double too_near_;                    ///< [m]
    std::vector<unsigned char> is_thin_; ///< [vertices] around a sliver

    std::vector<unsigned char> crosses_;       ///< [vertices] of triangles of cloth that cross
    std::vector<BodyCrossing> body_crossings_; ///< ascending
    std::vector<unsigned char> inside_;        ///< [cloth]
    View<const unsigned char> lets_through_;
    View<const Vec3> owner_normal_, body_normal_;
    int revision_ = 0;
};

} // namespace toile::collision
