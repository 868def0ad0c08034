#include "research/benchmarks/gpu/colliders.h"

#include <cmath>
#include <random>
#include <tuple>

#include "avatars/mannequin/mannequin.h"
#include "collision/body/cuda/detect.h"
#include "core/compute/parallel.h"
#include "research/benchmarks/best_time.h"
#include "research/benchmarks/gpu/median_time.h"
#include "research/benchmarks/text_table.h"

namespace toile::research::gpu {

namespace {

constexpr double kStep = 1.0 / 120.0; ///< [s]
constexpr double kClipTime = 0.3;     ///< [s] of the walk
constexpr double kOff = 0.004;        ///< [m] from the torso to the cloth
constexpr double kNoise = 0.001;      ///< [m] maximum random offset of a vertex along each axis
constexpr double kHem = 0.45, kHips = 0.90, kNeckline = 1.36; ///< [m] heights
constexpr double kGirth = 0.95;                               ///< [m] approximate circumference of the dress
constexpr double kCpuSeconds = 0.5;                           ///< of repetitions

MovingMesh walking_body()
{
    const std::unique_ptr<avatars::Avatar> body = avatars::make_mannequin();
    MovingMesh mesh{body->triangles(), std::vector<Vec3>(body->vertex_count()), {}};
    mesh.x_t1 = mesh.x_t0;
    const int walk = body->clip_index("walk_in_place");
    body->pose({walk, kClipTime - kStep}, avatars::Affine::Identity(), mesh.x_t0);
    body->pose({walk, kClipTime}, avatars::Affine::Identity(), mesh.x_t1);
    return mesh;
}

/// Distance of the cloth from the axis in a direction: found by marching outwards from inside the body.
double distance_from_axis(const collision::SurfaceProximity& body, const Vec3& axis, const Vec3& direction)
{
    double along = 0.0;
    for (int k = 0; k < 100; ++k) {
        const std::optional<collision::SurfacePoint> at = body.closest(axis + along * direction);
        if (!at || at->signed_distance >= kOff - 1e-4)
            break;
        along += kOff - at->signed_distance;
    }
    return along;
}

/// A tube with about this many vertices.
TriangleMesh dress_on(const collision::SurfaceProximity& body, int vertices)
{
    const double edge = std::sqrt((kNeckline - kHem) * kGirth / vertices);
    const int columns = int(std::lround(kGirth / edge)), rows = int(std::lround((kNeckline - kHem) / edge));
    std::mt19937 engine(1);
    const auto random = [&] { return 2.0 * double(engine()) / double(std::mt19937::max()) - 1.0; };
    TriangleMesh dress;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const double height = kHem + (kNeckline - kHem) * j / (rows - 1),
                         angle = 2.0 * M_PI * i / columns;
            const Vec3 direction(std::cos(angle), 0, std::sin(angle));
            const double off = distance_from_axis(body, Vec3(0, std::max(height, kHips), 0), direction);
            const double dx = random(), dy = random(), dz = random();
            dress.positions.emplace_back(Vec3(0, height, 0) + off * direction + kNoise * Vec3(dx, dy, dz));
        }
    for (int j = 0; j + 1 < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const int a = j * columns + i, b = j * columns + (i + 1) % columns;
            dress.triangles.emplace_back(a, a + columns, b);
            dress.triangles.emplace_back(b, a + columns, b + columns);
        }
    return dress;
}

int count_differences(const std::vector<collision::ContactPair>& cpu,
                      const std::vector<collision::ContactPair>& gpu)
{
    int different = int(std::max(cpu.size(), gpu.size()) - std::min(cpu.size(), gpu.size()));
    for (size_t i = 0; i < std::min(cpu.size(), gpu.size()); ++i)
        different += int(std::tie(cpu[i].kind, cpu[i].vertex, cpu[i].feature) !=
                         std::tie(gpu[i].kind, gpu[i].vertex, gpu[i].feature));
    return different;
}

ColliderSearch measure(const CudaSpace& space, const TriangleMesh& dress, const MovingMesh& body,
                       const collision::DetectSettings& settings)
{
    ColliderSearch search;
    search.vertices = dress.vertex_count();
    search.body_triangles = int(body.triangles.size());

    // CPU reference, moving back and forth: for a static body only moved vertices would be searched.
    collision::MeshCollider collider(body);
    collision::ContactDetector detector(dress.triangles, dress.positions);
    MovingMesh back{body.triangles, body.x_t1, body.x_t0};
    std::vector<collision::ContactPair> expected;
    const auto step_of = [&](const MovingMesh& mesh) {
        collider.move(mesh);
        detector.move(dress.positions);
        expected.clear();
        detector.detect(collider, 0, settings, expected);
    };
    search.cpu_us = 0.5e3 * best_ms(kCpuSeconds, [&] {
                        step_of(back);
                        step_of(body);
                    });

    DeviceArray<Vec3> x(space, "benchmarks/x"), x_t0(space, "benchmarks/x_t0"),
        x_t1(space, "benchmarks/x_t1");
    x.upload(dress.positions);
    x_t0.upload(body.x_t0);
    x_t1.upload(body.x_t1);
    collision::DeviceMeshCollider mesh(space, body.triangles, body.x_t0);
    collision::DeviceContactDetector device(space, dress.triangles, dress.positions);
    const auto refit = [&] {
        mesh.move(x_t0.view(), x_t1.view());
        device.move(x.view(), {}, settings);
    };
    refit();
    DeviceArray<collision::ContactPair> found(space, "benchmarks/pairs");
    found.upload(device.detect(mesh, 0));
    search.pairs = found.size();
    search.different = count_differences(expected, found.downloaded());

    search.refit_us = median_us(space, refit);
    search.planes_us = median_us(space, [&] { device.find_planes(space, mesh, 0); });
    if (settings.face_vertex)
        search.sheets_us = median_us(space, [&] { device.find_sheets(mesh, 0); });
    if (settings.edge_edge)
        search.ridges_us = median_us(space, [&] { device.find_ridges(space, mesh, 0); });
    search.report_us = median_us(space, [&] { device.report(mesh, 0); });
    search.total_us = median_us(space, [&] {
        refit();
        device.search(mesh, 0);
    });
    search.find_us = 1e3 * best_ms(0.1, [&] {
                         refit();
                         device.detect(mesh, 0);
                     });
    return search;
}

std::vector<Row> rows_of(const std::vector<ColliderSearch>& searches)
{
    std::vector<Row> rows;
    rows.reserve(searches.size());
    for (const ColliderSearch& s : searches)
        rows.push_back({s.kinds, std::to_string(s.vertices), std::to_string(s.body_triangles),
                        std::to_string(s.pairs), format("%.1f", s.refit_us), format("%.1f", s.planes_us),
                        format("%.1f", s.sheets_us), format("%.1f", s.ridges_us), format("%.1f", s.report_us),
                        format("%.1f", s.total_us), format("%.1f", s.find_us), format("%.0f", s.cpu_us),
                        format("%.1f", s.cpu_us / s.total_us), std::to_string(s.different)});
    return rows;
}

} // namespace

void measure_colliders(const CudaSpace& space, int vertices, std::vector<ColliderSearch>& out)
{
    const MovingMesh body = walking_body();
    const TriangleMesh dress = dress_on(collision::SurfaceProximity(body.triangles, body.x_t1), vertices);
    for (const bool are_all : {false, true}) {
        collision::DetectSettings settings;
        settings.face_vertex = settings.edge_edge = are_all;
        out.push_back(measure(space, dress, body, settings));
        out.back().kinds = are_all ? "all" : "vertices";
    }
}

std::string markdown_of(const std::vector<ColliderSearch>& searches)
{
    return "Pairs with a body; CPU on " + std::to_string(thread_count(kCpu)) + " threads\n\n" +
           markdown({"pairs of", "vertices", "body triangles", "pairs", "refit us", "planes us", "sheets us",
                     "ridges us", "report us", "total us", "find us", "CPU us", "CPU / GPU", "different"},
                    rows_of(searches));
}

std::string csv_of(const std::vector<ColliderSearch>& searches)
{
    return csv({"kinds", "vertices", "body_triangles", "pairs", "refit_us", "planes_us", "sheets_us",
                "ridges_us", "report_us", "total_us", "find_us", "cpu_us", "cpu_over_gpu", "different"},
               rows_of(searches));
}

} // namespace toile::research::gpu
