#include "research/benchmarks/gpu/near_pairs.h"

#include <cmath>
#include <random>

#include "collision/self/cuda/near_pairs.h"
#include "collision/self/near_pairs.h"
#include "core/compute/parallel.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/gpu/median_time.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::gpu {

namespace {

constexpr double kEdge = 0.01;          ///< [m]
constexpr double kMargin = 0.5 * kEdge; ///< [m]
constexpr int kLayers = 5;
constexpr double kWithin = 0.05, kAcross = 0.2; ///< [edges] random offset along the sheet and off it
constexpr double kMaxDisplacement = 0.1;        ///< [edges] maximum random displacement along each axis
constexpr double kCpuSeconds = 0.5;             ///< of repetitions

struct Folded {
    std::vector<Triangle> triangles;
    std::vector<Vec3> flat, x; ///< [m]
    std::vector<Vec3> motion;  ///< [m] of moving cloth: a fall plus a random displacement of every vertex
};

/// @param gap  between the layers [edges]
Folded folded_sheet(int vertices, double gap)
{
    const int side = int(std::lround(std::sqrt(vertices)));
    const int layer_length = (side + kLayers - 1) / kLayers;
    std::mt19937 engine(1);
    const auto random = [&] { return 2.0 * double(engine()) / double(std::mt19937::max()) - 1.0; };
    Folded sheet;
    for (int j = 0; j < side; ++j)
        for (int i = 0; i < side; ++i) {
            const int layer = i / layer_length, along = i % layer_length;
            const int column = layer % 2 == 0 ? along : layer_length - 1 - along;
            sheet.flat.emplace_back(kEdge * Vec3(i, 0, j));
            const double dx = kWithin * random(), dz = kWithin * random(), dy = kAcross * random();
            sheet.x.emplace_back(kEdge * Vec3(column + dx, gap * layer + dy, j + dz));
            const double ux = random(), uy = random(), uz = random();
            sheet.motion.emplace_back(kEdge * (kMaxDisplacement * Vec3(ux, uy, uz) - Vec3(0, 1, 0)));
        }
    for (int j = 0; j + 1 < side; ++j)
        for (int i = 0; i + 1 < side; ++i) {
            const int a = j * side + i, b = a + 1, c = a + side, d = c + 1;
            sheet.triangles.emplace_back(a, c, b);
            sheet.triangles.emplace_back(b, c, d);
        }
    return sheet;
}

int count_differences(const std::vector<collision::NearPair>& cpu,
                      const std::vector<collision::NearPair>& gpu)
{
    int different = int(std::max(cpu.size(), gpu.size()) - std::min(cpu.size(), gpu.size()));
    for (size_t i = 0; i < std::min(cpu.size(), gpu.size()); ++i)
        different += int(std::tie(cpu[i].vertex, cpu[i].first, cpu[i].second, cpu[i].is_facing) !=
                         std::tie(gpu[i].vertex, gpu[i].first, gpu[i].second, gpu[i].is_facing));
    return different;
}

NearSearch measure(const CudaSpace& space, const Folded& sheet, const std::vector<Vec3>& order_pose,
                   const std::vector<Vec3>& motion)
{
    NearSearch search;
    search.vertices = int(sheet.x.size());
    search.triangles = int(sheet.triangles.size());
    std::vector<collision::NearPair> expected;
    collision::NearPairs cpu(sheet.triangles, order_pose, {}, collision::NearPairs::Keeping::kNothing);
    search.cpu_us = 1e3 * best_ms(kCpuSeconds, [&] { cpu.find(sheet.x, {motion}, kMargin, expected); });

    DeviceArray<Vec3> positions(space, "benchmarks/x"), motions(space, "benchmarks/motion");
    positions.upload(sheet.x);
    motions.upload(motion);
    const View<const Vec3> x = positions.view();
    const collision::Trajectories trajectories{motions.view()};
    collision::DeviceNearPairs near(space, sheet.triangles, order_pose);
    DeviceArray<collision::NearPair> found(space, "benchmarks/pairs");
    found.upload(near.find(x, trajectories, kMargin));
    const std::vector<collision::NearPair> pairs = found.downloaded();
    search.pairs = int(pairs.size());
    search.facing = int(
        std::count_if(pairs.begin(), pairs.end(), [](const collision::NearPair& p) { return p.is_facing; }));
    search.different = count_differences(expected, pairs);

    search.refit_us = median_us(space, [&] { near.refit(x, trajectories, kMargin); });
    search.triangles_us = median_us(space, [&] { near.count_triangles(); });
    search.edges_us = median_us(space, [&] { near.count_edges(); });
    search.records_us = median_us(space, [&] { near.report(x, trajectories, kMargin); });
    search.total_us = median_us(space, [&] { near.search(x, trajectories, kMargin); });
    search.find_us = 1e3 * best_ms(0.1, [&] { near.find(x, trajectories, kMargin); });
    return search;
}

std::vector<Row> rows_of(const std::vector<NearSearch>& searches)
{
    std::vector<Row> rows;
    rows.reserve(searches.size());
    for (const NearSearch& s : searches)
        rows.push_back({s.scene, s.order, std::to_string(s.vertices), std::to_string(s.triangles),
                        std::to_string(s.pairs), std::to_string(s.facing), format("%.1f", s.refit_us),
                        format("%.1f", s.triangles_us), format("%.1f", s.edges_us),
                        format("%.1f", s.records_us), format("%.1f", s.total_us), format("%.1f", s.find_us),
                        format("%.0f", s.cpu_us), format("%.1f", s.cpu_us / s.total_us),
                        std::to_string(s.different)});
    return rows;
}

} // namespace

void measure_near_pairs(const CudaSpace& space, int vertices, std::vector<NearSearch>& out)
{
    for (const double gap : {1.0, 0.7}) {
        const Folded sheet = folded_sheet(vertices, gap);
        const auto add = [&](const char* moves, const char* order, const std::vector<Vec3>& pose,
                             const std::vector<Vec3>& motion) {
            out.push_back(measure(space, sheet, pose, motion));
            out.back().scene = format("%.1f", gap) + " edges apart " + moves;
            out.back().order = order;
        };
        add("at rest", "folded", sheet.x, {});
        add("at rest", "flat", sheet.flat, {});
        add("moving", "folded", sheet.x, sheet.motion);
    }
}

std::string markdown_of(const std::vector<NearSearch>& searches)
{
    return "Near pairs; CPU on " + std::to_string(thread_count(kCpu)) + " threads\n\n" +
           markdown({"five layers", "ordered", "vertices", "triangles", "pairs", "facing", "refit us",
                     "VT us", "EE us", "records us", "total us", "find us", "CPU us", "CPU / GPU",
                     "different"},
                    rows_of(searches));
}

std::string csv_of(const std::vector<NearSearch>& searches)
{
    return csv({"layers", "ordered", "vertices", "triangles", "pairs", "facing", "refit_us",
                "vertex_triangle_us", "edge_edge_us", "records_us", "total_us", "find_us", "cpu_us",
                "cpu_over_gpu", "different"},
               rows_of(searches));
}

} // namespace toile::research::gpu
