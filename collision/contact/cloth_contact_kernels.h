#pragma once

/// Kernels of ClothContact, per vertex and per pair. The same bodies on CPU and GPU.

#include <algorithm>
#include <array>

#include "collision/ccd/safe_motion.h"
#include "collision/geometry/contact_pair.h"
#include "collision/self/exempt_pairs.h"
#include "collision/self/pair_rules.h"

namespace toile::collision {

/// Slack of a vertex, relative to the error of its expected end in the last step [-]; and factor by which a
/// larger slack shrinks per step [-].
inline constexpr double kSlackGrowth = 1.5;
inline constexpr double kShrinking = 0.8;

/// Fraction of the thickness [-] that a pair must keep on its expected trajectory; otherwise it passes
/// through.
inline constexpr double kPassing = 0.1;

/// Bounds of the slack of a vertex [m].
struct SlackBounds {
    double min, max;
    TOILE_HD double of(double slack) const { return slack < min ? min : max < slack ? max : slack; }
};

/// Thickness of pairs.
struct PairThickness {
    View<const double> half; ///< [vertices] [m]

    /// Distance between the middle surfaces [m]. Each side is as thin as its thinnest vertex.
    TOILE_HD double of(const std::array<int, 4>& vertex, bool is_edge_edge) const
    {
        const int first = first_count(is_edge_edge);
        double side[2] = {half[vertex[0]], half[vertex[3]]};
        for (int k = 1; k < 3; ++k) {
            double& thinnest = side[k < first ? 0 : 1];
            thinnest = std::min(thinnest, half[vertex[k]]);
        }
        return side[0] + side[1];
    }
};

/// Expected motion of vertex v in a step: to its prediction, plus the deviation of the last step.
struct ExpectMotion {
    View<const Vec3> x, prediction, deviation; ///< [vertices] [m]
    View<Vec3> motion;                         ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const { motion[v] = prediction[v] + deviation[v] - x[v]; }
};

/// Expected end of vertex v.
struct ExpectEnd {
    View<const Vec3> x, motion; ///< [vertices] [m]
    View<Vec3> expected;        ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const { expected[v] = x[v] + motion[v]; }
};

/// Expected motion of vertex v after it was limited. Its slack covers the remaining distance to its requested
/// position, within the bounds.
struct ExpectRemaining {
    View<const Vec3> x, wanted; ///< [vertices] [m]
    bool goes_on;               ///< the remaining motion is expected; else none
    SlackBounds bounds;
    View<Vec3> motion;  ///< [vertices] out [m]
    View<double> slack; ///< [vertices] changed [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 rest = wanted[v] - x[v];
        motion[v] = goes_on ? rest : Vec3(Vec3::Zero());
        slack[v] = std::max(slack[v], bounds.of(rest.norm()));
    }
};

/// Updates deviation and slack of vertex v at the end of a step.
struct UpdateDeviation {
    View<const Vec3> x, prediction; ///< [vertices] [m]
    SlackBounds bounds;
    View<Vec3> deviation; ///< [vertices] changed [m]
    View<double> slack;   ///< [vertices] changed [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 now = x[v] - prediction[v];
        const double error = (now - deviation[v]).norm();
        slack[v] = bounds.of(std::max(kSlackGrowth * error, kShrinking * slack[v]));
        deviation[v] = now;
    }
};

/// Half space that a pair should respect, if it may press at all. It is taken at the expected end of the
/// step, or at the start if the pair would pass through in between. With the start alone, cloth that slides
/// over a border would meet the direction in which the border was ahead of it. A pair that has stopped cloth
/// presses whatever its direction: if nothing resisted, cloth would be stopped there again.
struct FindPressing {
    SoupView soup;
    View<const Vec3> base, motion, expected; ///< [vertices] start, displacement and end [m]
    View<const double> slack;                ///< [vertices] [m]
    PairThickness thickness;
    View<const unsigned char> stopped = {}; ///< [vertices] see ClothContact::stopped; empty: none

    /// @param now  the pair at the start
    /// @param out  written where the pair may press
    /// @return whether it may
    TOILE_HD bool operator()(const NearPair& now, ContactPair& out) const
    {
        const double thick = thickness.of(now.vertex, now.is_edge_edge);
        const bool passes =
            max_safe_step(now.is_edge_edge, corners_of(now.vertex, base), corners_of(now.vertex, motion),
                          std::min(kPassing * thick, 0.5 * now.distance)) < 1.0;
        if (!stopped.empty() && (passes || now.distance <= thick) && has_stopped(now)) {
            out = pair_of(now);
            return true;
        }
        double max_distance = 0.0;
        for (const int v : now.vertex)
            max_distance = std::max(max_distance, slack[v]);
        const NearPair near = passes ? now : soup.at(expected, now);
        // A normal that flips belongs to a vertex or edge that goes around a border, which other pairs stop.
        if (!passes && near.normal.dot(now.normal) < 0.0)
            return false;
        if (!near.is_facing || (!passes && near.distance > thick + 2.0 * max_distance))
            return false;
        out = pair_of(near);
        return true;
    }

private:
    TOILE_HD bool has_stopped(const NearPair& near) const
    {
        return stopped[near.vertex[0]] != 0 && stopped[near.vertex[1]] != 0 && stopped[near.vertex[2]] != 0 &&
               stopped[near.vertex[3]] != 0;
    }
    TOILE_HD static ContactPair pair_of(const NearPair& near)
    {
        ContactPair pair;
        pair.vertex = near.vertex;
        pair.weight = near.weight;
        pair.normal = near.normal;
        pair.kind = near.is_edge_edge ? ContactKind::kClothEdgeEdge : ContactKind::kClothVertexFace;
        return pair;
    }
};

/// Guard of a pair of cloth with a body: a half space on the side on which the cloth is.
struct GuardOf {
    int first_body;                    ///< vertex
    View<const Vec3> base;             ///< [vertices] start of the trajectories [m]
    View<const Vec3> motion;           ///< [bodies] displacement in the step [m]
    View<const int> collider;          ///< [bodies]
    View<const unsigned char> is_open; ///< [bodies] 1: of a surface without an inside
    View<const Vec3> outward;          ///< [bodies] normals; may be empty if none is open

    TOILE_HD bool is_of(const NearPair& near) const { return is_with_body(near, first_body); }

    /// @param pair  from FindPressing
    /// @param near  from which it was made
    TOILE_HD ContactPair operator()(const ContactPair& pair, const NearPair& near) const
    {
        ContactPair guard;
        guard.kind = ContactKind::kGuard;
        const bool is_cloth_first = pair.vertex[0] < first_body;
        const double side = is_cloth_first ? 1.0 : -1.0;
        guard.normal = side * pair.normal;
        guard.feature = is_cloth_first ? near.second : near.first;
        Vec3 ahead = Vec3::Zero();
        bool is_of_open = false;
        int used = 0;
        for (int k = 0; k < 4; ++k) {
            const int v = pair.vertex[k], b = v - first_body;
            const double weight = side * pair.weight[k];
            if (b < 0) {
                guard.vertex[used] = v;
                guard.weight[used++] = weight;
                continue;
            }
            guard.point -= weight * base[v];
            guard.motion -= weight * motion[b];
            guard.collider = collider[b];
            is_of_open = is_open[b] != 0;
            if (is_of_open)
                ahead += outward[b];
        }
        if (is_of_open && ahead.dot(guard.normal) < 0.0)
            guard.kind = ContactKind::kTwoSided;
        return guard;
    }
};

/// Part of the recovery speed [-] at which cloth that all surfaces pass through is pushed by its owner.
/// Layers that meet in an overlap push each other back.
inline constexpr double kCaughtRecovery = 0.3;

/// Factors of a term in a pinch [-]. How hard surfaces that overlap press is not physical, nor is friction by
/// that: it would tear cloth that they drag apart.
struct PinchedTerm {
    double friction = 1.0, recovery = 1.0;
};

/// Clearance of a plane [m] that no other opposes is larger.
inline constexpr double kNoOpposingPlane = 1.0;

/// Pairs with a collider that make no term: their cloth lets the body through, or a guard knows the side,
/// which a surface without an inside does not.
struct ReplacedPairs {
    View<const Vec3> base = {};             ///< [vertices] start of the trajectories [m]
    View<const unsigned char> is_open = {}; ///< [colliders] 1: without an inside; empty: nothing is replaced
    View<const unsigned char> lets_through = {}; ///< [cloth] see LetThrough; empty: no cloth does
    View<const Vec3> owner_normal = {};          ///< [cloth] likewise

    /// @param clearance  see ContactRules::term_of [m]
    TOILE_HD bool operator()(const ContactPair& pair, double clearance) const
    {
        if (is_open.empty() || pair.is_between_cloths())
            return false;
        if (pair.kind < ContactKind::kGuard && is_open[pair.collider] != 0 && pair.gap(base) < 0.0)
            return true; // it stays behind
        // A plane that opposes the owner's goes on pressing while there is room between them.
        const bool has_room =
            pair.kind < ContactKind::kGuard && clearance >= 0.0 && clearance < kNoOpposingPlane;
        for (int k = 0; k < pair.count() && !lets_through.empty(); ++k) {
            const int v = pair.vertex[k];
            const double ahead = owner_normal[v].dot(pair.normal);
            if (lets_through[v] != 0 && ahead < kOwnSheet &&
                (lets_through[v] == kLetsAll || !has_room || ahead > -kOwnSheet))
                return true;
        }
        return false;
    }

    /// How a pair of cloth that lets bodies through presses.
    TOILE_HD PinchedTerm pinched(const ContactPair& pair) const
    {
        PinchedTerm pinched;
        for (int k = 0; k < pair.count() && !lets_through.empty(); ++k) {
            const unsigned char lets = lets_through[pair.vertex[k]];
            if (lets != 0)
                pinched.friction = 0.0;
            if (!pair.is_between_cloths() &&
                (lets == kLetsAll || (lets != 0 && owner_normal[pair.vertex[k]].dot(pair.normal) < 0.0)))
                pinched.recovery = kCaughtRecovery;
        }
        return pinched;
    }
};

/// Marks the pairs that may press.
struct MarkPressing {
    FindPressing find;
    View<const NearPair> pairs;
    View<unsigned char> marks; ///< [pairs] out

    TOILE_HD void operator()(int i) const
    {
        ContactPair pair;
        marks[i] = (unsigned char)(find(pairs[i], pair) ? 1 : 0);
    }
};

/// Writes the i-th pair that may press. It is computed once more: few pairs press, and a list of all would be
/// long.
struct ReportPressing {
    FindPressing find;
    GuardOf guard_of;
    View<const NearPair> pairs;
    View<const int> indices; ///< of the pairs that may press
    View<ContactPair> out;

    TOILE_HD void operator()(int i) const
    {
        const NearPair& near = pairs[indices[i]];
        find(near, out[i]);
        if (guard_of.is_of(near))
            out[i] = guard_of(out[i], near);
    }
};

/// Returns 1 if a pair that presses at x has slid from the position at which its normal was expected, to
/// count them.
struct CountSlid {
    SoupView soup;
    View<const NearPair> pairs;
    View<const Vec3> x, expected; ///< [vertices] [m]
    PairThickness thickness;
    double max_distance; ///< [m] allowed slide

    TOILE_HD int operator()(int i) const
    {
        const NearPair& near = pairs[i];
        Vec3 deviation = Vec3::Zero();
        for (int k = 0; k < 4; ++k)
            deviation += near.weight[k] * (x[near.vertex[k]] - expected[near.vertex[k]]);
        if (deviation.squaredNorm() <= max_distance * max_distance)
            return 0;
        const NearPair now = soup.at(x, near);
        return now.is_facing && now.distance <= thickness.of(now.vertex, now.is_edge_edge) ? 1 : 0;
    }
};

} // namespace toile::collision
