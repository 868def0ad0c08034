#pragma once

#include <vector>

#include "core/backend/types.h"

namespace toile {

/// One of the cloths that a Contact looks after: how it keeps its distance, and what it is like to rub on.
/// The surface of a rigid body is one too.
struct ContactCloth {
    int vertex_count = 0;
    double mass = 1.0;                    ///< [kg] of all of it
    bool is_rigid = false;                ///< never touches itself, and moves or is held back as a whole
    double gap = 0.002;                   ///< [m] between the cloth's middle surface and a collider
    double thickness = 0.5e-3;            ///< [m] half of it is kept to the middle surface of other cloth
    std::vector<double> partner_friction; ///< [partners] Coulomb coefficients [-]
    std::vector<double> cloth_friction;   ///< [cloths] with each of the cloths, itself included [-]
};

/// For each vertex the number of its rigid body, -1 in cloth; empty where nothing is rigid.
/// @param cloths  whose vertices follow each other
std::vector<int> rigid_bodies_of(const std::vector<ContactCloth>& cloths);

/// Of those that cloths keep to colliders [m].
double largest_gap(const std::vector<ContactCloth>& cloths);

/// [vertices] The shortest altitude of the triangles around each [m].
std::vector<double> shortest_altitudes(View<const Triangle> triangles, View<const Vec3> x);

/// What ContactRules and PushRules ask of the cloths.
struct ContactTables {
    /// @param cloths     whose vertices follow each other
    /// @param positions  [vertices] start positions [m]
    ContactTables(const std::vector<ContactCloth>& cloths, int partner_count, View<const Triangle> triangles,
                  View<const Vec3> positions);

    std::vector<int> cloth_of;            ///< [vertices]
    std::vector<double> gap;              ///< [cloths] [m]
    std::vector<double> partner_friction; ///< [cloths x partners] [-]
    std::vector<double> cloth_friction;   ///< [cloths x cloths] [-]
    std::vector<int> rigid;               ///< [vertices] see rigid_bodies_of
    std::vector<double> altitude;         ///< [vertices] see shortest_altitudes [m]
};

} // namespace toile
