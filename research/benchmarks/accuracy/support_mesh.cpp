#include "research/benchmarks/accuracy/support_mesh.h"

#include <cmath>
#include <numbers>

namespace toile::research::accuracy {

TriangleMesh support_mesh()
{
    constexpr int kSides = 96;
    TriangleMesh mesh;
    for (const double height : {-0.2, 0.0}) {
        for (int i = 0; i < kSides; ++i) {
            const double angle = 2.0 * std::numbers::pi * i / kSides;
            mesh.positions.emplace_back(0.09 * std::cos(angle), height, 0.09 * std::sin(angle));
        }
        mesh.positions.emplace_back(0.0, height, 0.0);
    }
    const int upper = kSides + 1;
    for (int i = 0; i < kSides; ++i) {
        const int next = (i + 1) % kSides;
        mesh.triangles.emplace_back(kSides, i, next);
        mesh.triangles.emplace_back(upper + kSides, upper + next, upper + i);
        mesh.triangles.emplace_back(i, upper + i, upper + next);
        mesh.triangles.emplace_back(i, upper + next, next);
    }
    return mesh;
}

} // namespace toile::research::accuracy
