#pragma once

/// ClothContact vertex by vertex and pair by pair. The same bodies on CPU and GPU.

#include <algorithm>
#include <array>

#include "collision/cloth/pair_rules.h"
#include "collision/cloth/safe_motion.h"
#include "collision/contact_pair.h"

namespace toile {

/// How far a vertex may come from where it was expected: this much more than in the step before [-], what was
/// allowed then shrinking by a share each step.
inline constexpr double kMoreThanBefore = 1.5;
inline constexpr double kShrinking = 0.8;

/// Share of the thickness [-] that a pair must keep on its expected way, or it passes through.
inline constexpr double kPassing = 0.1;

/// Bounds of how far a vertex may come from where it was expected [m].
struct SlackBounds {
    double least, most;
    TOILE_HD double of(double slack) const { return slack < least ? least : most < slack ? most : slack; }
};

/// Thickness of pairs.
struct PairThickness {
    View<const double> half; ///< [vertices] [m]

    /// Between the middle surfaces [m]. Both sides are as thin as their thinnest vertex.
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

/// Where vertex v should go in a step: as predicted, and astray as in the step before.
struct ExpectMotion {
    View<const Vec3> x, prediction, deviation; ///< [vertices] [m]
    View<Vec3> motion;                         ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const { motion[v] = prediction[v] + deviation[v] - x[v]; }
};

/// Where it should end.
struct ExpectEnd {
    View<const Vec3> x, motion; ///< [vertices] [m]
    View<Vec3> expected;        ///< [vertices] out [m]
    TOILE_HD void operator()(int v) const { expected[v] = x[v] + motion[v]; }
};

/// From where vertex v was brought back to: as far around its expected motion as it had wanted to go.
struct LookOn {
    View<const Vec3> x, wanted; ///< [vertices] [m]
    bool goes_on;               ///< it will try the rest of its way again; else it stays
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

/// Learns at the end of a step how far vertex v came from what was predicted.
struct LearnDeviation {
    View<const Vec3> x, prediction; ///< [vertices] [m]
    SlackBounds bounds;
    View<Vec3> deviation; ///< [vertices] changed [m]
    View<double> slack;   ///< [vertices] changed [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 now = x[v] - prediction[v];
        const double error = (now - deviation[v]).norm();
        slack[v] = bounds.of(std::max(kMoreThanBefore * error, kShrinking * slack[v]));
        deviation[v] = now;
    }
};

/// The half space that a pair should respect, if it may press at all: as it will be at the expected end of
/// the step, or as it is now where it would pass through on the way. Cloth that slides over a border must not
/// meet the direction in which the border was ahead of it.
struct FindPressing {
    SoupView soup;
    View<const Vec3> base, motion, expected; ///< [vertices] the start, the way from there and its end [m]
    View<const double> slack;                ///< [vertices] [m]
    PairThickness thickness;

    /// @param now  as it is at the start
    /// @param out  written where the pair may press
    /// @return whether it may
    TOILE_HD bool operator()(const NearPair& now, ContactPair& out) const
    {
        const double thick = thickness.of(now.vertex, now.is_edge_edge);
        double farthest = 0.0;
        for (const int v : now.vertex)
            farthest = std::max(farthest, slack[v]);
        const bool passes =
            safe_share(now.is_edge_edge, corners_of(now.vertex, base), corners_of(now.vertex, motion),
                       std::min(kPassing * thick, 0.5 * now.distance)) < 1.0;
        const NearPair near = passes ? now : soup.at(expected, now);
        // Around a border to the other side only goes what nothing has stopped yet: other pairs do.
        if (!passes && near.normal.dot(now.normal) < 0.0)
            return false;
        if (!near.is_facing || (!passes && near.distance > thick + 2.0 * farthest))
            return false;
        out = ContactPair{};
        out.vertex = near.vertex;
        out.weight = near.weight;
        out.normal = near.normal;
        out.kind = near.is_edge_edge ? ContactKind::kClothEdgeEdge : ContactKind::kClothVertexFace;
        return true;
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

/// The i-th pair that may press. It is found once more: hardly any do, and a list of all would be long.
struct ReportPressing {
    FindPressing find;
    View<const NearPair> pairs;
    View<const int> places; ///< those of pairs that may press
    View<ContactPair> out;

    TOILE_HD void operator()(int i) const { find(pairs[places[i]], out[i]); }
};

/// 1 where a pair that presses at x has slid away from the place that its normal was expected at; a term of
/// how many have.
struct CountSlid {
    SoupView soup;
    View<const NearPair> pairs;
    View<const Vec3> x, expected; ///< [vertices] [m]
    PairThickness thickness;
    double farthest; ///< [m] that none has slid

    TOILE_HD int operator()(int i) const
    {
        const NearPair& near = pairs[i];
        Vec3 strayed = Vec3::Zero();
        for (int k = 0; k < 4; ++k)
            strayed += near.weight[k] * (x[near.vertex[k]] - expected[near.vertex[k]]);
        if (strayed.squaredNorm() <= farthest * farthest)
            return 0;
        const NearPair now = soup.at(x, near);
        return now.is_facing && now.distance <= thickness.of(now.vertex, now.is_edge_edge) ? 1 : 0;
    }
};

} // namespace toile
