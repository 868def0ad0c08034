#pragma once

#include <string>
#include <vector>

#include "research/benchmarks/stress/cases.h"
#include "volume/energy/elastic_solid.h"

namespace toile::research::stress {

/// A bar of tetrahedra that is held at one end, under gravity, for a second or 200 steps. Nothing touches
/// it.
struct SolidCase {
    std::string name;
    volume::TetMesh mesh;            ///< at rest
    std::vector<unsigned char> held; ///< [vertices]
    std::vector<Vec3> start;         ///< [vertices] [m]
    volume::ElasticMaterial material;
    double dt = 0.0; ///< [s]
    int steps = 0;
};

/// Every combination of mesh (regular, with slivers), start (at rest, random), Young's modulus, Poisson's
/// ratio and step length. Names begin with "solid".
std::vector<SolidCase> make_solid_cases(Size size);

} // namespace toile::research::stress
