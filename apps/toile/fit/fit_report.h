#pragma once

#include <string>
#include <vector>

#include "apps/toile/fit/garment_girth.h"
#include "apps/toile/maps/vertex_map.h"

namespace toile::app {

/// How a garment fits its body.
struct GarmentFit {
    FittedGarment garment;
    std::vector<GirthFit> girths;
    std::string not_measured;    ///< why there are no girths; empty if there are
    Vec3 front = Vec3::UnitZ();  ///< that the body faces, if it was measured
    std::vector<VertexMap> maps; ///< tension, strain, gap
};

/// @param body  in the frame of the garment
GarmentFit fit_of(FittedGarment garment, const TriangleMesh& body, const std::string& body_source);

/// Girths with their ease, and the ranges of the maps, as JSON. docs/reference/commands.md explains the keys.
std::string to_json(const std::vector<GarmentFit>& fits);

/// Values of the maps, a row for each vertex in the order of the mesh, after a header with names and units.
std::string to_csv(const GarmentFit& fit);

} // namespace toile::app
