#include "collision/body/cuda/detect_report.h"

#include <limits>
#include <numeric>

#include <gtest/gtest.h>

#include "collision/body/clearance_kernels.h"
#include "collision/body/cuda/sides_kernels.h"
#include "tests/collision/collider_cases.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/collision/geometry/surface_on_cpu.h"

namespace toile::test {

using namespace collision;

namespace {

using test::ColliderCase;
using test::Random;
using test::SurfaceOnCpu;

/// Query of DeviceContactDetector: its kernels, run on the CPU.
class DetectOnCpu {
public:
    explicit DetectOnCpu(const TriangleMesh& cloth, int capacity = 120)
        : capacity_(capacity), cloth_(cloth), order_(cloth.positions.size()), sides_(cloth.positions.size())
    {
        std::iota(order_.begin(), order_.end(), 0);
    }

    std::vector<ContactPair> detect(View<const Vec3> x, const ColliderCase& what, int collider)
    {
        const MovingMesh& moving = what.mesh;
        const DetectSettings& settings = what.settings;
        const std::vector<Vec3> positions(x.begin(), x.end());
        const SurfaceOnCpu mesh(moving.triangles, moving.x_t1, {}, 0.0);
        const SurfaceOnCpu cloth(cloth_.triangles, positions, {}, 0.0);
        const DeviceSearch search{x,        what.reach,      search_of(mesh),    moving.x_t0,
                                  collider, settings.radius, settings.max_depth, settings.max_motion};
        find(search, cloth);
        return report(search, cloth);
    }

    bool had_capacity() const { return max_found_ <= capacity_; }

    /// Stores the clearance found by the last query, which the next query uses to skip vertices [m].
    void update_clearance()
    {
        clearance_.resize(in_front_.size(), 0.0);
        parallel_for(kCpu, "test/learn_clearance", int(in_front_.size()),
                     UpdateClearance{in_front_, clearance_});
    }
    auto left_out() const { return std::count(in_front_.begin(), in_front_.end(), -1.0); }
    const std::vector<VertexSides>& sides() const { return sides_; }

    void update(View<const Vec3> x, const MovingMesh& moving, int collider)
    {
        const SurfaceOnCpu mesh(moving.triangles, moving.x_t1, {}, 0.0);
        nearest_.assign(x.size(), -1);
        parallel_for(kCpu, "test/learn", x.size(),
                     UpdateSides{x, search_of(mesh), collider, order_, nearest_, sides_, clearance_});
    }

private:
    static SurfaceSearch search_of(const SurfaceOnCpu& surface)
    {
        return {{surface.triangles, surface.x, view_of(surface.edges)},
                surface.triangle_tree(),
                surface.edge_tree(),
                surface.extent};
    }

    void find(const DeviceSearch& search, const SurfaceOnCpu& cloth)
    {
        const int vertices = search.x.size();
        nearest_.assign(vertices, -1);
        plane_items_.resize(VertexPlanes::kMax * size_t(vertices));
        planes_ = {plane_items_, vertices};
        plane_counts_.resize(vertices);
        in_front_.resize(vertices);
        parallel_for(
            kCpu, "test/planes", vertices,
            FindPlanes{search, order_, sides_, nearest_, planes_, plane_counts_, in_front_, clearance_});
        find_sheets(search, cloth);
        find_ridges(search, cloth);
    }

    void find_sheets(const DeviceSearch& search, const SurfaceOnCpu& cloth)
    {
        const int triangles = int(cloth_.triangles.size());
        std::vector<int> found(triangles + 1, 0);
        sheet_items_.assign(capacity_ * size_t(triangles), kUnwritten);
        sheets_ = {sheet_items_, triangles};
        const SurfaceView surface = search_of(cloth).surface;
        parallel_for(kCpu, "test/sheets", triangles,
                     FindSheets{search, surface, cloth.triangle_items(), sheets_, found});
        max_found_ = std::max(max_found_, *std::max_element(found.begin(), found.end()));
        std::vector<long> first(found.size());
        std::exclusive_scan(found.begin(), found.end(), first.begin(), 0L);

        // Capacity slightly above the need.
        const int capacity = int(first.back()) + 3;
        std::vector<std::uint64_t> keys(capacity);
        std::vector<int> slots(capacity);
        parallel_for(kCpu, "test/clear", capacity, ClearSheetKeys{keys, slots});
        parallel_for(kCpu, "test/keys", triangles, KeySheets{first, sheets_, keys, slots});
        sorted_sheets_ = sorted(keys, slots);
        sheet_counts_.resize(capacity);
        const std::vector<int> rank = ranks_by_corners(cloth_.triangles);
        parallel_for(kCpu, "test/keep_sheets", capacity,
                     KeepSheets{search, surface, sheets_, sorted_sheets_, rank, sheet_counts_, keys, slots});
        sorted_sheets_ = sorted(keys, slots);
    }

    static std::vector<int> sorted(const std::vector<std::uint64_t>& keys, const std::vector<int>& slots)
    {
        std::vector<int> order(keys.size()), result;
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return keys[a] < keys[b]; });
        for (const int i : order)
            result.push_back(slots[i]);
        return result;
    }

    void find_ridges(const DeviceSearch& search, const SurfaceOnCpu& cloth)
    {
        const int edges = cloth.edges.edge_count();
        std::vector<int> found(edges + 1, 0);
        ridge_items_.assign(capacity_ * size_t(edges), kUnwritten);
        ridges_ = {ridge_items_, edges};
        ridge_counts_.resize(edges);
        parallel_for(kCpu, "test/ridges", edges,
                     FindRidges{search, cloth.edge_items(), cloth.edges.vertex, ridges_, found});
        max_found_ = std::max(max_found_, *std::max_element(found.begin(), found.end()));
        parallel_for(kCpu, "test/keep_ridges", edges,
                     KeepRidges{search, cloth.edges.vertex, found, ridges_, ridge_counts_});
    }

    std::vector<ContactPair> report(const DeviceSearch& search, const SurfaceOnCpu& cloth)
    {
        std::vector<int> counts = plane_counts_;
        counts.insert(counts.end(), sheet_counts_.begin(), sheet_counts_.end());
        counts.insert(counts.end(), ridge_counts_.begin(), ridge_counts_.end());
        counts.push_back(0);
        std::vector<long> first(counts.size());
        std::exclusive_scan(counts.begin(), counts.end(), first.begin(), 0L);
        const PairSlots pair_slots{first, planes_.queries, int(sheet_counts_.size())};
        std::vector<ContactPair> pairs(first.back());
        parallel_for(kCpu, "test/report_planes", planes_.queries,
                     ReportPlanes{search, plane_counts_, planes_, pair_slots, pairs});
        parallel_for(
            kCpu, "test/report_sheets", int(sorted_sheets_.size()),
            ReportSheet{search, search_of(cloth).surface, sorted_sheets_, sheets_, pair_slots, pairs});
        parallel_for(kCpu, "test/report_ridges", ridges_.queries,
                     ReportRidges{search, cloth.edges.vertex, ridge_counts_, ridges_, pair_slots, pairs});
        return pairs;
    }

    /// Marks a slot that no kernel has written; it is no valid index.
    static constexpr int kUnwritten = std::numeric_limits<int>::max();

    int capacity_; ///< number of slots of a query
    int max_found_ = 0;
    const TriangleMesh& cloth_;
    std::vector<int> order_, nearest_;
    std::vector<VertexSides> sides_;
    std::vector<int> plane_items_, sheet_items_, ridge_items_, sorted_sheets_;
    std::vector<int> plane_counts_, sheet_counts_, ridge_counts_;
    std::vector<double> in_front_, clearance_;
    Slots planes_, sheets_, ridges_;
};

/// Lower bounds of the number of pairs of each kind.
struct MinPairs {
    int vertex_face, face_vertex, edge_edge;
};

void expect_those_of_the_detector(const ColliderCase& made, const MinPairs& min_pairs)
{
    const MeshCollider collider(made.mesh);
    ContactDetector detector(made.cloth.triangles, made.cloth.positions);
    std::vector<ContactPair> expected;
    detector.move(made.cloth.positions, made.reach);
    detector.detect(collider, 3, made.settings, expected);
    const auto count = [&](ContactKind kind) {
        return std::count_if(expected.begin(), expected.end(),
                             [&](const ContactPair& pair) { return pair.kind == kind; });
    };
    EXPECT_GE(count(ContactKind::kVertexFace), min_pairs.vertex_face) << made.name;
    EXPECT_GE(count(ContactKind::kFaceVertex), min_pairs.face_vertex) << made.name;
    EXPECT_GE(count(ContactKind::kEdgeEdge), min_pairs.edge_edge) << made.name;
    DetectOnCpu bodies(made.cloth);
    test::expect_same(expected, bodies.detect(made.cloth.positions, made, 3), made.cloth.positions,
                      made.name);
    EXPECT_TRUE(bodies.had_capacity()) << made.name;
}

TEST(DeviceDetectKernels, MatchTheDetectorOnABall)
{
    Random random(51);
    for (const int levels : {2, 4, 5}) {
        ColliderCase made = test::ball_case(random, 40, levels);
        expect_those_of_the_detector(made, {800, levels > 2 ? 100 : 0, levels > 2 ? 1000 : 0});
        add_reach(made, random);
        expect_those_of_the_detector(made, {200, 0, 0});
    }
}

TEST(DeviceDetectKernels, MatchTheDetectorBetweenBalls)
{
    Random random(52);
    expect_those_of_the_detector(test::between_balls(random), {300, 200, 300});
}

TEST(DeviceDetectKernels, MatchTheDetectorInSoups)
{
    Random random(53);
    for (int i = 0; i < 10; ++i)
        expect_those_of_the_detector(test::soup_in_soup(random), {50, 50, 50});
}

TEST(DeviceDetectKernels, FindFewerPairsBeyondTheirCapacity)
{
    Random random(56);
    const ColliderCase made = test::soup_in_soup(random);
    DetectOnCpu with(made.cloth), without(made.cloth, 2);
    EXPECT_LT(without.detect(made.cloth.positions, made, 3).size(),
              with.detect(made.cloth.positions, made, 3).size());
    EXPECT_TRUE(with.had_capacity());
    EXPECT_FALSE(without.had_capacity());
}

TEST(DeviceDetectKernels, SkipVerticesKnownToBeClear)
{
    Random random(57);
    ColliderCase made = test::ball_case(random, 40, 4);
    add_reach(made, random);
    DetectOnCpu plain(made.cloth), informed(made.cloth);
    const View<const Vec3> x = made.cloth.positions;
    const std::vector<ContactPair> expected = plain.detect(x, made, 3);
    informed.detect(x, made, 3);
    const auto first = informed.left_out();
    informed.update_clearance();
    EXPECT_TRUE(test::are_same_bits(expected, informed.detect(x, made, 3)));
    EXPECT_GT(informed.left_out(), first + 100);
    plain.update(x, made.mesh, 3);
    informed.update(x, made.mesh, 3);
    for (size_t v = 0; v < plain.sides().size(); ++v)
        for (int k = 0; k < kMaxSides; ++k)
            EXPECT_EQ(plain.sides()[v][k].triangle, informed.sides()[v][k].triangle);
}

TEST(DeviceDetectKernels, AcceptEmptyInput)
{
    Random random(54);
    ColliderCase made = test::soup_in_soup(random);
    made.mesh.triangles.clear();
    expect_those_of_the_detector(made, {0, 0, 0});
    made = test::soup_in_soup(random);
    made.cloth.triangles.clear();
    expect_those_of_the_detector(made, {10, 0, 0});
}

TEST(DeviceDetectKernels, MatchContactSideHistory)
{
    Random random(55);
    ColliderCase made = test::between_balls(random);
    const int vertices = made.cloth.vertex_count();
    MeshCollider collider(made.mesh);
    ContactDetector detector(made.cloth.triangles, made.cloth.positions);
    ContactSideHistory sides(vertices);
    DetectOnCpu bodies(made.cloth);
    int remembered = 0;
    for (int step = 0; step < 4; ++step) {
        // The upper ball sinks into the lower one.
        made.mesh.x_t0 = made.mesh.x_t1;
        for (size_t v = 0; v < made.mesh.x_t1.size() / 2; ++v)
            made.mesh.x_t1[v] += Vec3(0.001, -0.003, 0.0005);
        collider.move(made.mesh);
        std::vector<ContactPair> expected, plain;
        detector.move(made.cloth.positions);
        detector.detect(collider, 3, made.settings, expected, &sides);
        detector.detect(collider, 3, made.settings, plain);
        remembered += int(!test::are_same_bits(expected, plain));
        test::expect_same(expected, bodies.detect(made.cloth.positions, made, 3), made.cloth.positions,
                          "step " + std::to_string(step));
        sides.update(made.cloth.positions, collider, 3, Clearance(vertices));
        bodies.update(made.cloth.positions, made.mesh, 3);
    }
    EXPECT_GT(remembered, 0);
}

} // namespace
} // namespace toile::test
