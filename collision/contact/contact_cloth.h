#pragma once

#include <vector>

#include "core/compute/types.h"

namespace toile::collision {

/// Parameters of one cloth in a Contact: distances and friction. The surface of a rigid body is a cloth too.
struct ContactCloth {
    int vertex_count = 0;
    double mass = 1.0;                     ///< [kg] in total
    bool is_rigid = false;                 ///< no self-contact; moves and is limited as a whole
    double gap = 0.002;                    ///< [m] between the cloth's middle surface and a collider
    double thickness = 0.5e-3;             ///< [m] half of it is kept to the middle surface of other cloth
    std::vector<double> vertex_thickness;  ///< [vertices] [m] at most `thickness`; empty: `thickness`
    std::vector<double> collider_friction; ///< [colliders] Coulomb coefficients [-]
    std::vector<double> cloth_friction;    ///< [cloths] with each of the cloths, itself included [-]

    /// Thickness of a vertex [m].
    double thickness_at(int v) const
    {
        return vertex_thickness.empty() ? thickness : vertex_thickness[size_t(v)];
    }
    /// Gap of a vertex to colliders [m].
    double gap_at(int v) const { return gap - 0.5 * (thickness - thickness_at(v)); }
};

/// Number of each vertex's rigid body, -1 in cloth; empty if nothing is rigid.
/// @param cloths  whose vertices follow each other
std::vector<int> rigid_bodies_of(const std::vector<ContactCloth>& cloths);

/// Largest gap that cloths keep to colliders [m].
double largest_gap(const std::vector<ContactCloth>& cloths);

/// Room that cloth needs between two surfaces that face each other [m]: a gap at both, and a layer of cloth
/// on each with cloth between them.
/// @param gap  between a collider and the surface of the cloth [m]
constexpr double room_of(double gap, double thickness) { return 2.0 * gap + 3.0 * thickness; }
double room_of(const std::vector<ContactCloth>& cloths); ///< the largest

/// Shortest altitude of the triangles around each vertex, [vertices] [m].
std::vector<double> shortest_altitudes(View<const Triangle> triangles, View<const Vec3> x);

/// Tables of the cloths for ContactRules and ProjectionRules.
struct ContactTables {
    /// @param cloths     whose vertices follow each other
    /// @param positions  [vertices] start positions [m]
    ContactTables(const std::vector<ContactCloth>& cloths, int collider_count, View<const Triangle> triangles,
                  View<const Vec3> positions);

    std::vector<int> cloth_of;             ///< [vertices]
    std::vector<double> gap;               ///< [cloths] [m]
    std::vector<double> vertex_gap;        ///< [vertices] [m]; empty where all have that of their cloth
    std::vector<double> collider_friction; ///< [cloths x colliders] [-]
    std::vector<double> cloth_friction;    ///< [cloths x cloths] [-]
    std::vector<int> rigid;                ///< [vertices] see rigid_bodies_of
    std::vector<double> altitude;          ///< [vertices] see shortest_altitudes [m]
};

} // namespace toile::collision
