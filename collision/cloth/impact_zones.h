#pragma once

#include <algorithm>
#include <vector>

#include "core/backend/types.h"

namespace toile {

/// Vertices in each other's way, joined into zones that go on together. A vertex goes where its zone goes,
/// plus a share of what its own way differs from that; at share 0 a zone keeps its shape, and momentum
/// (counting vertices of cloth alike) is kept at any share that all have in common. What moves as a whole, a
/// rigid body, is one vertex here, its first, with a weight.
/// [Provot 1997, Collision and self-collision handling in cloth model dedicated to design garments: impact
/// zones]. Deviation: theirs are rigid at once; here by as much as is needed.
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
    void set_body(int v, const Vec3& way, double weight) { sum_[v] = {weight * way, weight, Hold::kNone}; }

    /// Makes the zones of two vertices one.
    void join(int a, int b);

    /// After close_round() v goes at most this factor of the share that it goes now.
    void bring_back(int v, double factor) { next_share_[v] = std::min(next_share_[v], factor * share_[v]); }
    void close_round();

    double share(int v) const { return share_[v]; }                        ///< [-]
    bool leans(int v) const { return sum_[zone(v)].hold == Hold::kLeans; } ///< the zone of v goes with a body

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

    double slow_ = 0.0; ///< [m]
    View<const Vec3> ways_;
    std::vector<double> share_, next_share_; ///< [vertices]
    std::vector<int> parent_;                ///< [vertices] a forest; roots name zones
    std::vector<Sum> sum_;                   ///< [vertices] of roots
};

} // namespace toile
