#include "research/benchmarks/near_pairs/cases.h"

#include <cmath>
#include <numbers>
#include <random>

namespace toile::research::near_pairs {

namespace {

constexpr double kEdge = 0.01;         // [m]
constexpr double kLayerHeight = 0.003; // [m]
constexpr int kLayers = 20;

void add_sheet(Case& cloth, int side, double height)
{
    const int first = int(cloth.x.size());
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i)
            cloth.x.emplace_back(kEdge * i, height, kEdge * j);
    for (int j = 0; j + 1 < side; ++j)
        for (int i = 0; i + 1 < side; ++i) {
            const int a = first + j * side + i, b = a + 1, c = a + side, d = c + 1;
            cloth.triangles.emplace_back(a, c, b);
            cloth.triangles.emplace_back(b, c, d);
        }
}

Case sheet(const std::string& name, int vertices)
{
    Case cloth{name, {}, {}};
    add_sheet(cloth, int(std::lround(std::sqrt(vertices))), 0.0);
    return cloth;
}

/// Half as large, and deformed by plane waves in all directions: crumpled cloth.
Case crumpled(int vertices)
{
    constexpr int kWaves = 6;
    constexpr double kAmplitude = 0.02; // [m]
    struct Wave {
        Vec3 amplitude, number;
        double phase;
    };
    std::mt19937 engine(1);
    std::uniform_real_distribution<double> unit(-1.0, 1.0), length(0.10, 0.25);
    const auto direction = [&] { return Vec3(unit(engine), unit(engine), unit(engine)).normalized(); };
    std::vector<Wave> waves(kWaves);
    for (Wave& wave : waves) {
        wave.amplitude = kAmplitude * direction();
        wave.number = (2.0 * std::numbers::pi / length(engine)) * direction();
        wave.phase = std::numbers::pi * unit(engine);
    }

    Case cloth = sheet("crumpled", vertices);
    for (Vec3& x : cloth.x) {
        const Vec3 flat = x;
        x *= 0.5;
        for (const Wave& wave : waves)
            x += std::sin(wave.number.dot(flat) + wave.phase) * wave.amplitude;
    }
    return cloth;
}

Case stacked(int vertices)
{
    Case cloth{"20 sheets", {}, {}};
    for (int layer = 0; layer < kLayers; ++layer)
        add_sheet(cloth, int(std::lround(std::sqrt(vertices / kLayers))), kLayerHeight * layer);
    return cloth;
}

} // namespace

std::vector<Case> cases(int vertices)
{
    return {sheet("flat", vertices), crumpled(vertices), stacked(vertices)};
}

} // namespace toile::research::near_pairs
