#pragma once

#include <vector>

#include "collision/cloth/vertex_set.h"

namespace toile {

/// Vertices in each other's way, joined into zones that go on together. A vertex goes where its zone goes,
/// plus a share of what its own way differs from that; at share 0 a zone keeps its shape, and momentum
/// (counting vertices of cloth alike) is kept at any share that all have in common. What moves as a whole, a
/// rigid body, is one vertex here, its first, with a weight.
/// [Provot 1997, Collision and self-collision handling in cloth model dedicated to design garments: impact
/// zones]. Deviation: theirs are rigid at once; here by as much as is needed.
///
/// But for what holds each vertex, which reset() copies, all costs what is in zones, not what is not.
class ImpactZones {
public:
    /// What holds a vertex: cloth that lies on a body goes where that lets it, held cloth where it is led.
    enum class Hold : unsigned char { kNone, kLeans, kIsHeld };

    /// Every vertex by itself, with all of its way.
    /// @param ways  [vertices] [m]; borrowed
    /// @param hold  [vertices] where a zone goes is settled by its vertices of the greatest hold; borrowed
    ///              during the call
    /// @param slow  [m] zones that would go less far stay: cloth at rest would creep
    void reset(View<const Vec3> ways, View<const Hold> hold, double slow);

    /// @param way     of all of a body whose first vertex is v [m]
    /// @param weight  against that of a vertex of cloth [-]
    void set_body(int v, const Vec3& way, double weight);

    /// Makes the zones of two vertices one.
    void join(int a, int b) { unite(a, b, true); }
    /// The same, but where only one of them is more than a vertex it goes where it went, until settle(): a
    /// zone that grows by many vertices one after the other need not move with each.
    void attach(int a, int b) { unite(a, b, false); }

    /// After close_round() v goes at most this factor of the share that it goes now, or this share.
    void bring_back(int v, double factor) { bring_back_to(v, factor * share_[v]); }
    void bring_back_to(int v, double share);

    /// All zones go where their vertices let them. False when they did.
    bool settle();
    /// Whose motion may have changed since the last round was closed; borrowed until the next.
    View<const int> close_round();
    bool has_changed(int v) const { return changed_.has(v); } ///< is among these

    double share(int v) const { return share_[v]; } ///< [-]
    /// The zone of v goes with a body.
    bool leans(int v) const { return sum_of(zone(v)).hold == Hold::kLeans; }

    Vec3 common(int v) const; ///< where the zone of v goes [m]
    Vec3 motion(int v) const; ///< of v, a vertex of cloth [m]

private:
    /// Weighted sum of the ways of a zone's vertices of the greatest hold; of held ones the slowest.
    struct Sum {
        Vec3 way;
        double weight;
        Hold hold;
    };

    int zone(int v) const;
    void shorten_path(int v);
    void touch(int v);
    void unite(int a, int b, bool at_once);
    void add(Sum& sum, const Sum& other) const;
    Sum sum_of(int root) const;
    Vec3 common_of(const Sum& sum) const;
    void go_on(int root);

    double slow_ = 0.0; ///< [m]
    View<const Vec3> ways_;
    std::vector<Hold> hold_;                 ///< [vertices]
    VertexSet touched_;                      ///< the others are by themselves, with all of their ways
    std::vector<double> share_, next_share_; ///< [vertices]
    std::vector<int> parent_;                ///< [vertices] a forest; roots name zones
    std::vector<int> next_;                  ///< [vertices] of the same zone, in a ring
    std::vector<Sum> sum_;                   ///< [vertices] of touched roots
    std::vector<Vec3> common_;               ///< [vertices] of touched roots: where they go [m]
    VertexSet unsettled_;                    ///< roots, some of them former ones, whose sum has changed since
    VertexSet redirected_;                   ///< those whose common_ has changed since the last round
    VertexSet brought_back_;                 ///< since the last round
    VertexSet renewed_, changed_;            ///< by the last round: roots; vertices
};

} // namespace toile
