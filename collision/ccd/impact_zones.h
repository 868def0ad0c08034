#pragma once

#include <vector>

#include "collision/ccd/vertex_set.h"

namespace toile::collision {

/// Zones of vertices that block each other [Provot 1997, Collision and self-collision handling in cloth model
/// dedicated to design garments: impact zones]. A vertex moves by its zone's common displacement plus a
/// fraction of its deviation from that. At fraction 0 a zone keeps its shape. Momentum, with equal masses of
/// cloth vertices, is conserved at any fraction that all vertices share. A rigid body is represented by its
/// first vertex, with a weight. Deviation: Provot's zones are rigid at once; here only as far as needed.
///
/// Costs depend on the vertices in zones only, except for the support of each vertex, which reset() copies.
class ImpactZones {
public:
    /// Support of a vertex: none, a body that constrains cloth lying on it, or a prescribed motion.
    enum class Support : unsigned char { kNone, kSupported, kFixed };

    /// Makes every vertex a single zone, with its full displacement.
    /// @param displacements  [vertices] [m]; borrowed
    /// @param support  [vertices] a zone's displacement depends on its vertices of the strongest support;
    ///                 copied
    /// @param slow  [m] zones with a smaller displacement stay: resting cloth would creep
    void reset(View<const Vec3> displacements, View<const Support> support, double slow);

    /// @param displacement     of the body whose first vertex is v [m]
    /// @param weight  relative to a vertex of cloth [-]
    void set_body(int v, const Vec3& displacement, double weight);

    /// Merges the zones of two vertices.
    void join(int a, int b);

    /// Bounds the fraction of v, from close_pass() on, by `factor` times the current one.
    void limit_by(int v, double factor);

    /// Applies the bounds of the pass. Returns the vertices whose motion may have changed since the last
    /// call; borrowed until the next.
    View<const int> close_pass();
    bool has_changed(int v) const { return changed_.has(v); } ///< v is among these

    double fraction(int v) const { return fraction_[v]; } ///< [-]

    Vec3 common(int v) const; ///< displacement of the zone of v [m]
    Vec3 motion(int v) const; ///< displacement of v, a vertex of cloth [m]

private:
    /// Weighted sum of the displacements of a zone's vertices of the strongest support; for fixed ones the
    /// smallest displacement.
    struct Sum {
        Vec3 displacement;
        double weight;
        Support support;
    };

    int zone(int v) const;
    void shorten_path(int v);
    void activate(int v);
    void add(Sum& sum, const Sum& other) const;
    Sum sum_of(int root) const;
    Vec3 common_of(const Sum& sum) const;

    double slow_ = 0.0; ///< [m]
    View<const Vec3> displacements_;
    std::vector<Support> support_;                 ///< [vertices]
    VertexSet active_;                             ///< all others are single, with full displacement
    std::vector<double> fraction_, next_fraction_; ///< [vertices]
    std::vector<int> parent_;                      ///< [vertices] forest; a root identifies its zone
    std::vector<int> next_;                        ///< [vertices] of the same zone, in a ring
    std::vector<Sum> sum_;                         ///< [vertices] of active roots
    std::vector<Vec3> common_;                     ///< [vertices] displacement of active roots [m]
    VertexSet redirected_;        ///< roots, some of them former ones, renewed since the last pass
    VertexSet limited_;           ///< vertices bounded since the last pass
    VertexSet renewed_, changed_; ///< by the last pass: roots; vertices
};

} // namespace toile::collision
