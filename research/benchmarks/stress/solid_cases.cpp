#include "research/benchmarks/stress/solid_cases.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "research/benchmarks/bar.h"
#include "research/benchmarks/stress/random_positions.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::stress {

namespace {

const Vec3 kBar(0.3, 0.1, 0.1); ///< [m]

/// Height of a sliver over that of the tetrahedron that holds it [-].
constexpr double kSliverHeight = 1e-3;

/// Splits every sixth tetrahedron at a point just above the middle of a face: one of the four is a sliver.
volume::TetMesh with_slivers(volume::TetMesh mesh)
{
    const int count = mesh.tet_count();
    for (int t = 0; t < count; t += 6) {
        const auto [a, b, c, d] = mesh.tets[size_t(t)];
        const Vec3 middle = (mesh.positions[a] + mesh.positions[b] + mesh.positions[c]) / 3.0;
        const int p = mesh.vertex_count();
        mesh.positions.push_back(middle + kSliverHeight * (mesh.positions[d] - middle));
        mesh.tets[size_t(t)] = {a, b, c, p};
        mesh.tets.insert(mesh.tets.end(), {{p, b, c, d}, {a, p, c, d}, {a, b, p, d}});
    }
    return mesh;
}

/// Vertices that are not held lie anywhere in the bar.
std::vector<Vec3> random_start(const SolidCase& of)
{
    std::vector<Vec3> start = random_positions({Vec3::Zero(), kBar, 7}, of.mesh.positions.size());
    for (size_t v = 0; v < start.size(); ++v)
        if (of.held[v])
            start[v] = of.mesh.positions[v];
    return start;
}

} // namespace

std::vector<SolidCase> make_solid_cases(Size size)
{
    const bool quick = size == Size::Quick;
    const volume::TetMesh regular = bar_of_tets(kBar, quick ? std::array{3, 1, 1} : std::array{6, 2, 2});
    const auto values = [&](std::vector<double> all) {
        return quick ? std::vector<double>{all.front(), all.back()} : all;
    };
    const double duration = quick ? 0.2 : 1.0; // [s]
    constexpr int kMaxSteps = 200;
    std::vector<SolidCase> cases;
    for (const bool has_slivers : {false, true})
        for (const bool is_random : {false, true})
            for (const double young : values({1e3, 1e5, 1e7, 1e9}))
                for (const double poisson : values({0.0, 0.3, 0.49}))
                    for (const double rate : values({1000, 120, 30, 10})) {
                        SolidCase& of = cases.emplace_back();
                        of.name = std::string("solid ") + (has_slivers ? "with slivers" : "regular") +
                                  (is_random ? " random start" : "") + " young " + format("%g", young) +
                                  " poisson " + format("%g", poisson) + " dt 1/" + format("%g", rate);
                        of.mesh = has_slivers ? with_slivers(regular) : regular;
                        for (const Vec3& p : of.mesh.positions)
                            of.held.push_back(p.x() == 0.0);
                        of.start = is_random ? random_start(of) : of.mesh.positions;
                        of.material = {young, poisson};
                        of.dt = 1.0 / rate;
                        of.steps = std::min(int(std::lround(duration * rate)), kMaxSteps);
                    }
    return cases;
}

} // namespace toile::research::stress
