#include <algorithm>
#include <filesystem>
#include <iostream>

#include "collision/body/cuda/detect.h"
#include "core/compute/cuda/runtime/graph.h"
#include "core/mesh/obj.h"
#include "tests/collision/collider_cases.h"
#include "tests/collision/contact_pairs_compared.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace collision;

namespace {

class DeviceContactDetectorTest : public OnDevice {
protected:
    /// Inputs of a case on the device.
    struct OnBoard {
        OnBoard(const CudaSpace& space, const ColliderCase& made)
            : mesh(space, made.mesh.triangles, made.mesh.x_t1), x(space, "test/x"), x_t0(space, "test/x_t0"),
              x_t1(space, "test/x_t1"), reach(space, "test/reach")
        {
            move(made);
        }
        void move(const ColliderCase& made)
        {
            x.upload(made.cloth.positions);
            x_t0.upload(made.mesh.x_t0);
            x_t1.upload(made.mesh.x_t1);
            reach.upload(made.reach);
            mesh.move(x_t0.view(), x_t1.view());
        }

        DeviceMeshCollider mesh;
        DeviceArray<Vec3> x, x_t0, x_t1;
        DeviceArray<double> reach;
    };

    std::vector<ContactPair> downloaded(View<const ContactPair> pairs)
    {
        DeviceArray<ContactPair> copy(space(), "test/pairs", pairs.size());
        copy.upload(pairs);
        return copy.downloaded();
    }
    std::vector<ContactPair> found_by(DeviceContactDetector& device, OnBoard& board, const ColliderCase& made,
                                      const DeviceContactSideHistory* sides = nullptr)
    {
        device.move(board.x.view(), board.reach.view(), made.settings);
        return downloaded(device.detect(board.mesh, 3, sides));
    }

    static std::vector<ContactPair> expected_of(const ColliderCase& made)
    {
        const MeshCollider collider(made.mesh);
        ContactDetector host(made.cloth.triangles, made.cloth.positions);
        std::vector<ContactPair> expected;
        host.move(made.cloth.positions, made.reach);
        host.detect(collider, 3, made.settings, expected);
        return expected;
    }

    /// Compares CPU and GPU twice; the second query of the GPU starts at the nearest triangles of the first.
    void compare(const ColliderCase& made, size_t min_count)
    {
        OnBoard board(space(), made);
        DeviceContactDetector device(space(), made.cloth.triangles, made.cloth.positions);
        const std::vector<ContactPair> expected = expected_of(made);
        EXPECT_GE(expected.size(), min_count) << made.name;
        const std::vector<ContactPair> first = found_by(device, board, made);
        expect_same(expected, first, made.cloth.positions, made.name);
        EXPECT_TRUE(are_same_bits(first, found_by(device, board, made))) << made.name;
        count_ += expected.size();
    }
    size_t count() const { return count_; } ///< number of pairs compared

private:
    size_t count_ = 0;
};

TEST_F(DeviceContactDetectorTest, MatchesTheCpuOnABall)
{
    Random random(61);
    for (const int levels : {2, 4, 5}) {
        ColliderCase made = ball_case(random, 60, levels);
        compare(made, 1000);
        add_reach(made, random);
        compare(made, 200);
        made.settings.face_vertex = false;
        compare(made, 200);
        made.settings.edge_edge = false;
        compare(made, 100);
    }
}

TEST_F(DeviceContactDetectorTest, MatchesTheCpuBetweenBallsAndInSoups)
{
    Random random(62);
    compare(between_balls(random), 1000);
    for (int i = 0; i < 5; ++i)
        compare(soup_in_soup(random), 1000);
}

TEST_F(DeviceContactDetectorTest, AcceptsEmptyInput)
{
    Random random(63);
    ColliderCase made = soup_in_soup(random);
    made.mesh.triangles.clear();
    compare(made, 0);
    made = soup_in_soup(random);
    made.cloth.triangles.clear();
    compare(made, 10);
}

TEST_F(DeviceContactDetectorTest, RemembersSidesAsOnTheCpu)
{
    Random random(64);
    ColliderCase made = between_balls(random);
    const int vertices = made.cloth.vertex_count();
    MeshCollider collider(made.mesh);
    ContactDetector host(made.cloth.triangles, made.cloth.positions);
    ContactSideHistory sides(vertices);
    OnBoard board(space(), made);
    DeviceContactDetector device(space(), made.cloth.triangles, made.cloth.positions);
    DeviceContactSideHistory device_sides(space(), vertices);
    for (int step = 0; step < 5; ++step) {
        // The upper ball sinks into the lower one.
        made.mesh.x_t0 = made.mesh.x_t1;
        for (size_t v = 0; v < made.mesh.x_t1.size() / 2; ++v)
            made.mesh.x_t1[v] += Vec3(0.001, -0.003, 0.0005);
        collider.move(made.mesh);
        board.move(made);
        std::vector<ContactPair> expected;
        host.move(made.cloth.positions);
        host.detect(collider, 3, made.settings, expected, &sides);
        expect_same(expected, found_by(device, board, made, &device_sides), made.cloth.positions,
                    "step " + std::to_string(step));
        sides.update(made.cloth.positions, collider, 3, Clearance(vertices));
        device.update_sides(board.x.view(), board.mesh, 3, device_sides);
    }
    const std::vector<ContactPair> with = found_by(device, board, made, &device_sides);
    device_sides.forget();
    EXPECT_FALSE(are_same_bits(with, found_by(device, board, made, &device_sides)));
    EXPECT_TRUE(are_same_bits(found_by(device, board, made), found_by(device, board, made, &device_sides)));
}

TEST_F(DeviceContactDetectorTest, AppendsTheMeshesOneByOneWhileItGrows)
{
    Random random(65);
    const ColliderCase made = ball_case(random, 60, 4);
    ColliderCase other = made;
    for (Vec3& x : other.mesh.x_t1)
        x += Vec3(0.004, 0.01, 0);
    std::vector<ContactPair> expected = expected_of(made);
    const std::vector<ContactPair> second = expected_of(other);
    expected.insert(expected.end(), second.begin(), second.end());

    OnBoard board(space(), made), other_board(space(), other);
    DeviceContactDetector device(space(), made.cloth.triangles, made.cloth.positions, 1);
    const auto find_both = [&] {
        device.move(board.x.view(), {}, made.settings);
        device.detect(board.mesh, 3);
        device.detect(other_board.mesh, 3);
    };
    find_both();
    expect_same(expected, downloaded(device.pairs()), made.cloth.positions, "both");
    EXPECT_EQ(allocations_of(find_both), 0);
    expect_same(expected, downloaded(device.pairs()), made.cloth.positions, "both again");
}

Eigen::Isometry3d random_pose(Random& random)
{
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.linear() = Eigen::AngleAxisd(random.uniform(0, 3), random.point().normalized()).toRotationMatrix();
    pose.translation() = 0.05 * random.point();
    return pose;
}

TEST_F(DeviceContactDetectorTest, MatchesTheCpuOnSolids)
{
    Random random(68);
    std::array<int, 3> kinds{};
    for (const int cells : {6, 40}) {
        TriangleMesh cloth = testing::sheet_mesh(0.6, cells, 0.0);
        for (const Shape& shape : {Shape(PlaneShape{Vec3(0, 0.6, 0.8)}), Shape(SphereShape{0.05}),
                                   Shape(CapsuleShape{0.1, 0.03}), Shape(BoxShape{Vec3(0.1, 0.06, 0.15)})})
            for (int i = 0; i < 10; ++i) {
                for (Vec3& x : cloth.positions)
                    x.y() = random.uniform(-0.06, 0.06) / cells * 6;
                ShapeCollider collider(shape, random_pose(random), "test");
                collider.move(collider.pose(), random_pose(random));
                DetectSettings settings;
                settings.radius = 0.03;
                ContactDetector host(cloth.triangles, cloth.positions);
                std::vector<ContactPair> expected;
                host.detect(collider, 5, settings, expected);
                DeviceContactDetector device(space(), cloth.triangles, cloth.positions, 1);
                DeviceArray<Vec3> x(space(), "test/x");
                x.upload(cloth.positions);
                device.move(x.view(), {}, settings);
                expect_same(expected, downloaded(device.detect(collider, 5)), cloth.positions,
                            "shape " + std::to_string(shape.index()));
                for (const ContactPair& pair : expected)
                    ++kinds[int(pair.kind) - int(ContactKind::kVertexShape)];
            }
    }
    for (const int count : kinds)
        EXPECT_GT(count, 50);
}

TEST_F(DeviceContactDetectorTest, FindsTheSameBitsFromAGraph)
{
    Random random(66);
    const ColliderCase made = ball_case(random, 60, 4);
    OnBoard board(space(), made);
    DeviceContactDetector device(space(), made.cloth.triangles, made.cloth.positions);
    const std::vector<ContactPair> first = found_by(device, board, made);
    CudaGraph graph(space(), "test/graph");
    graph.record([&] {
        device.move(board.x.view(), {}, made.settings);
        device.search(board.mesh, 3);
    });
    for (int k = 0; k < 2; ++k) {
        device.move(board.x.view(), {}, made.settings);
        graph.launch();
        EXPECT_TRUE(device.complete());
        EXPECT_TRUE(are_same_bits(first, downloaded(device.pairs())));
    }
}

TEST_F(DeviceContactDetectorTest, MatchesTheCpuOnABody)
{
    const std::filesystem::path file = std::filesystem::path(TOILE_DATA_DIR) / "bodies/smpl_f_template.obj";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no bodies/smpl_f_template.obj";
    const TriangleMesh body = read_obj(file).triangulated();
    Random random(67);
    ColliderCase made{"a body", subdivide(body, 1), shaken(body, 0.002, random), {}, {}};
    const std::vector<Vec3> normals = vertex_normals(made.cloth.positions, made.cloth.triangles);
    for (size_t v = 0; v < normals.size(); ++v)
        made.cloth.positions[v] += random.uniform(-0.004, 0.012) * normals[v] + 0.002 * random.point();
    compare(made, 10000);
    add_reach(made, random);
    compare(made, 1000);
    std::cout << "compared " << count() << " pairs of " << made.cloth.vertex_count() << " vertices with "
              << body.triangle_count() << " triangles\n";
}

} // namespace
} // namespace toile::test
