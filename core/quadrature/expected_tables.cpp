#include "core/quadrature/expected_tables.h"

#include <cmath>

#include "core/quadrature/solve_costs.h"

namespace toile {

namespace {

/// Law c (n / 10 000)^p of n nodes.
struct PowerLaw {
    double at_ten_thousand, power;
    double operator()(int n) const { return at_ten_thousand * std::pow(1e-4 * n, power); }
};

/// Seconds of one thread. Surfaces of 2 500 to 50 000 nodes, volumes of 800 to 16 000.
constexpr PowerLaw kCpuSurface{0.9, 2.0}, kCpuVolume{4.0, 2.5};

/// Seconds of a GPU, and of its host that factors. Surfaces of 10 000 to 240 000 nodes, volumes of 10 000.
constexpr PowerLaw kGpuSurface{0.083, 1.2}, kGpuVolume{0.28, 1.5};

/// Numbers read per node of a volume at its tolerance of 0.07. Letters of 800 to 16 000 nodes.
constexpr PowerLaw kVolumeGathers{325.0, 0.14};

/// Numbers per node of stiff cloth, relative to expected_gathers() [-].
constexpr double kStiffGathers = 1.5;

/// Size of tables on a GPU, where most weights are bytes, relative to single weights [-].
constexpr double kPacked = 1.0 / 2.6;

double single_bytes(int nodes, Extent extent)
{
    const double gathers =
        extent == Extent::Surface ? kStiffGathers * expected_gathers(nodes) : kVolumeGathers(nodes);
    return sizeof(float) * gathers * nodes;
}

} // namespace

ExpectedTables expected_tables(int nodes, Extent extent, int threads)
{
    const PowerLaw& seconds = extent == Extent::Surface ? kCpuSurface : kCpuVolume;
    return {seconds(nodes) / threads, single_bytes(nodes, extent)};
}

ExpectedTables expected_tables_on_gpu(int nodes, Extent extent)
{
    const PowerLaw& seconds = extent == Extent::Surface ? kGpuSurface : kGpuVolume;
    return {seconds(nodes), kPacked * single_bytes(nodes, extent)};
}

} // namespace toile
