#include "collision/self/near_pairs.h"

#include <algorithm>
#include <filesystem>
#include <iostream>

#include "collision/geometry/surface_proximity.h"
#include "collision/self/cuda/near_pairs.h"
#include "core/base/stages.h"
#include "core/compute/cuda/runtime/graph.h"
#include "core/mesh/obj.h"
#include "tests/collision/self/pairs_near_vertices.h"
#include "tests/collision/self/same_pairs.h"
#include "tests/collision/soups.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace collision;

namespace {

class DeviceNearPairsTest : public OnDevice {
protected:
    /// Soup in device memory, so that searches wait for no host data.
    struct OnBoard {
        OnBoard(const CudaSpace& space, const Soup& soup, const std::vector<unsigned char>& selected = {})
            : x(space, "test/x"), motion(space, "test/motion"), slack(space, "test/slack"),
              selected_(space, "test/around")
        {
            x.upload(soup.x);
            send(soup, selected);
        }
        void send(const Soup& soup, const std::vector<unsigned char>& selected)
        {
            motion.upload(soup.motion);
            slack.upload(soup.slack);
            selected_.upload(selected);
        }
        Trajectories trajectories() { return {motion.view(), slack.view(), selected_.view()}; }

        DeviceArray<Vec3> x, motion;
        DeviceArray<double> slack;
        DeviceArray<unsigned char> selected_;
    };

    std::vector<NearPair> found_by(DeviceNearPairs& near, const Soup& soup, double margin,
                                   const std::vector<unsigned char>& selected = {})
    {
        OnBoard board(space(), soup, selected);
        const View<const NearPair> pairs = near.find(board.x.view(), board.trajectories(), margin);
        return downloaded(near, pairs.size());
    }
    /// Near pairs of marked vertices with the current trajectories of the soup.
    std::vector<NearPair> found_near(DeviceNearPairs& near, OnBoard& board, const Soup& soup,
                                     const std::vector<unsigned char>& selected, double margin)
    {
        board.send(soup, selected);
        const int count = int(std::count(selected.begin(), selected.end(), 1));
        return downloaded(near, near.find_near(board.x.view(), board.trajectories(), count, margin).size());
    }
    std::vector<NearPair> downloaded(const DeviceNearPairs& near, int count)
    {
        DeviceArray<NearPair> copy(space(), "test/pairs");
        copy.upload(near.pairs().subview(0, count));
        return copy.downloaded();
    }

    /// Compares CPU and GPU, both from their initial state.
    void compare(const Soup& soup, double margin, const std::string& what, std::vector<int> rigid = {},
                 const std::vector<unsigned char>& selected = {})
    {
        DeviceNearPairs device(space(), soup.triangles, soup.x, rigid);
        NearPairs host(soup.triangles, soup.x, std::move(rigid));
        std::vector<NearPair> expected;
        host.find(soup.x, {soup.motion, soup.slack, selected}, margin, expected);
        expect_same(expected, found_by(device, soup, margin, selected), what);
        count_ += expected.size();
    }
    size_t count() const { return count_; } ///< number of pairs compared

    /// Two sheets, one above the other, of more vertices than the search near few vertices handles.
    static Soup two_sheets()
    {
        Soup soup;
        for (const double height : {0.0, 0.006})
            add_sheet(soup, 60, 0.01, height);
        return soup;
    }

private:
    size_t count_ = 0;
};

TEST_F(DeviceNearPairsTest, MatchTheCpuInRandomSoups)
{
    Random random(31);
    size_t total = 0;
    for (int i = 0; i < 10; ++i) {
        Soup soup = random_soup(random);
        NearPairs host(soup.triangles, soup.x);
        DeviceNearPairs device(space(), soup.triangles, soup.x);
        std::vector<NearPair> expected;
        for (const double margin : {0.0, 0.01, 0.1}) {
            host.find(soup.x, soup.trajectories(), margin, expected);
            expect_same(expected, found_by(device, soup, margin), "soup " + std::to_string(i));
            total += expected.size();
            for (Vec3& x : soup.x)
                x += 0.3 * random.point() + Vec3(100, 0, 0);
        }
    }
    EXPECT_GT(total, 5000u);
}

TEST_F(DeviceNearPairsTest, MatchTheCpuOnFoldedSheets)
{
    Random random(32);
    for (int i = 0; i < 3; ++i) {
        Soup soup = folded_sheet(random);
        compare(soup, 0.002, "moving");
        soup.stand_still();
        compare(soup, 0.004, "at rest");
    }
    EXPECT_GT(count(), 5000u);
}

TEST_F(DeviceNearPairsTest, AreOnlyThoseOfTheSelectedVertices)
{
    Random random(33);
    const Soup soup = folded_sheet(random);
    std::vector<unsigned char> selected(soup.x.size());
    for (int i = 0; i < 20; ++i)
        selected[random.below(int(selected.size()))] = 1;
    compare(soup, 0.003, "around", {}, selected);
    EXPECT_GT(count(), 100u);
    compare(soup, 0.003, "around nothing", {}, std::vector<unsigned char>(soup.x.size()));
}

TEST_F(DeviceNearPairsTest, AreFoundNearVerticesWithChangedTrajectories)
{
    Random random(33);
    size_t total = 0;
    for (int i = 0; i < 6; ++i) {
        Soup soup = i % 2 == 0 ? random_soup(random) : folded_sheet(random);
        DeviceNearPairs device(space(), soup.triangles, soup.x, {}, 1);
        OnBoard board(space(), soup);
        device.find(board.x.view(), board.trajectories(), 0.003);
        for (const int vertices : {1, 30, 36, 43, 52, 62, 75, 90, 110, 130, 160, 200}) { // grows by a fifth
            const std::vector<unsigned char> selected = send_elsewhere(random, soup, vertices);
            const std::vector<NearPair> found = found_near(device, board, soup, selected, 0.003);
            expect_pairs_near(found, soup, selected, 0.003);
            EXPECT_TRUE(are_same_bits(found, found_near(device, board, soup, selected, 0.003)));
            total += found.size();
        }
    }
    EXPECT_GT(total, 5000u);
}

TEST_F(DeviceNearPairsTest, AreFoundNearManyVerticesByAFullSearch)
{
    Random random(42);
    Soup soup = two_sheets();
    DeviceNearPairs device(space(), soup.triangles, soup.x);
    OnBoard board(space(), soup);
    device.find(board.x.view(), board.trajectories(), 0.003);
    std::vector<unsigned char> selected(soup.x.size());
    for (size_t v = 0; v < soup.x.size(); v += 1 + size_t(random.below(2))) {
        selected[v] = 1;
        soup.motion[v] = 3e-3 * random.point();
    }
    Stages stages;
    const Stages::Activate activate(stages);
    const std::vector<NearPair> found = found_near(device, board, soup, selected, 0.003);
    EXPECT_EQ(stages.calls("collision/device_count_near"), 0);
    expect_pairs_near(found, soup, selected, 0.003);
    EXPECT_GT(found.size(), 10000u);
}

/// For many vertices the boxes have a smaller margin, until the next search, which is a recorded graph.
TEST_F(DeviceNearPairsTest, AreFoundNearFewVerticesAfterManyAndARecordedSearch)
{
    Random random(43);
    Soup soup = two_sheets();
    DeviceNearPairs device(space(), soup.triangles, soup.x);
    OnBoard board(space(), soup);
    const auto find = [&] {
        board.send(soup, {});
        device.find(board.x.view(), board.trajectories(), 0.004);
    };
    for (int k = 0; k < 2; ++k)
        find(); // recorded
    found_near(device, board, soup, std::vector<unsigned char>(soup.x.size(), 1), 0.0005);
    find();
    const std::vector<unsigned char> selected = send_elsewhere(random, soup, 100);
    const std::vector<NearPair> found = found_near(device, board, soup, selected, 0.004);
    expect_pairs_near(found, soup, selected, 0.004);
    EXPECT_GT(found.size(), 1000u);
}

TEST_F(DeviceNearPairsTest, NeedNoLaunchForAnEmptySelection)
{
    Random random(40);
    const Soup soup = folded_sheet(random);
    DeviceNearPairs device(space(), soup.triangles, soup.x);
    OnBoard board(space(), soup);
    device.find(board.x.view(), board.trajectories(), 0.003);
    Stages stages;
    const Stages::Activate activate(stages);
    EXPECT_TRUE(device.find_near(board.x.view(), board.trajectories(), 0, 0.003).empty());
    EXPECT_EQ(stages.calls("collision/device_count_near"), 0);
}

TEST_F(DeviceNearPairsTest, AreNotWithinOneRigidBody)
{
    Random random(34);
    const Soup soup = folded_sheet(random);
    std::vector<int> rigid(soup.x.size());
    for (size_t v = 0; v < rigid.size(); ++v)
        rigid[v] = int(v / 24) % 3 - 1; // rows of the sheet; -1 is no body
    compare(soup, 0.003, "rigid", rigid);
    EXPECT_GT(count(), 100u);
}

/// Rows of a folded sheet take the parts of cloth, of a rigid body and of prescribed bodies.
TEST_F(DeviceNearPairsTest, AreNotWithinBodiesWhoseMotionIsGiven)
{
    Random random(44);
    for (const int cloth : {-1, kTogether}) {
        const Soup soup = folded_sheet(random);
        const std::array<int, 3> parts{cloth, cloth == kTogether ? cloth : 0, kPrescribed};
        std::vector<int> rigid(soup.x.size());
        for (size_t v = 0; v < rigid.size(); ++v)
            rigid[v] = parts[v / 48 % 3];
        std::vector<unsigned char> selected(soup.x.size());
        for (int i = 0; i < 60; ++i)
            selected[random.below(int(selected.size()))] = 1;
        compare(soup, 0.003, "all", rigid);
        compare(soup, 0.003, "selected", rigid, selected);
    }
    EXPECT_GT(count(), 100u);
}

/// A collider is a rigid body of the soup, and only its vertices are selected. The result is the pairs of
/// cloth and collider.
TEST_F(DeviceNearPairsTest, OfAColliderInTheSoupAreItsPairsWithCloth)
{
    Random random(39);
    Soup soup;
    add_sheet(soup, 20, 0.01, 0.0);
    const int cloth_vertices = int(soup.x.size()), cloth_triangles = int(soup.triangles.size());
    add_sheet(soup, 15, 0.013, 0.004);
    for (Vec3& x : soup.x)
        x += 2e-3 * random.point();
    std::vector<int> rigid(soup.x.size(), -1);
    std::vector<unsigned char> selected(soup.x.size(), 0);
    std::fill(rigid.begin() + cloth_vertices, rigid.end(), 0);
    std::fill(selected.begin() + cloth_vertices, selected.end(), 1);
    constexpr double kRadius = 0.005;
    compare(soup, kRadius, "collider", rigid, selected);

    // Vertices of either against triangles of the other, as the tree over the avatars' triangles finds them.
    DeviceNearPairs device(space(), soup.triangles, soup.x, rigid);
    std::vector<std::pair<int, int>> found, expected;
    for (const NearPair& pair : found_by(device, soup, kRadius, selected))
        if (!pair.is_edge_edge)
            found.emplace_back(pair.first, pair.second);
    const std::vector<Triangle> cloth(soup.triangles.begin(), soup.triangles.begin() + cloth_triangles);
    const std::vector<Triangle> collider(soup.triangles.begin() + cloth_triangles, soup.triangles.end());
    const SurfaceProximity cloth_surface(cloth, soup.x), collider_surface(collider, soup.x);
    std::vector<int> within;
    for (int v = 0; v < int(soup.x.size()); ++v) {
        const bool is_cloth = v < cloth_vertices;
        (is_cloth ? collider_surface : cloth_surface).triangles_within(soup.x[v], kRadius, within);
        for (const int t : within)
            expected.emplace_back(v, t + (is_cloth ? cloth_triangles : 0));
    }
    EXPECT_EQ(found, expected);
    EXPECT_GT(found.size(), 500u);
}

TEST_F(DeviceNearPairsTest, MatchTheCpuForFewTriangles)
{
    Soup soup;
    compare(soup, 1.0, "nothing");
    soup.x = {Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0.2, 0, 1)};
    soup.stand_still();
    compare(soup, 1.0, "no triangle");
    soup.triangles = {{0, 1, 2}};
    compare(soup, 1.0, "one triangle");
    EXPECT_EQ(count(), 0u);
    for (const Vec3& x : {Vec3(0.3, 0.5, 0.1), Vec3(1.4, 0.6, 0), Vec3(0.4, 0.7, 1.1)})
        soup.x.push_back(x);
    soup.stand_still();
    soup.triangles.emplace_back(3, 4, 5);
    compare(soup, 1.0, "two triangles");
    EXPECT_GT(count(), 5u);
}

TEST_F(DeviceNearPairsTest, GrowWithoutLosingPairsAndThenAllocateNothing)
{
    Random random(35);
    const Soup soup = folded_sheet(random);
    std::vector<NearPair> expected;
    NearPairs(soup.triangles, soup.x).find(soup.x, soup.trajectories(), 0.003, expected);
    DeviceNearPairs device(space(), soup.triangles, soup.x, {}, 1);
    expect_same(expected, found_by(device, soup, 0.003), "grown");

    OnBoard board(space(), soup);
    EXPECT_EQ(allocations_of([&] { device.find(board.x.view(), board.trajectories(), 0.003); }), 0);
    expect_same(expected, downloaded(device, int(expected.size())), "grown before");
}

TEST_F(DeviceNearPairsTest, HaveTheSameBitsInEveryRunAlsoFromAGraph)
{
    Random random(36);
    const Soup soup = folded_sheet(random);
    DeviceNearPairs device(space(), soup.triangles, soup.x);
    const std::vector<NearPair> first = found_by(device, soup, 0.003);
    EXPECT_TRUE(are_same_bits(first, found_by(device, soup, 0.003)));
    DeviceNearPairs other(space(), soup.triangles, soup.x, {}, 1);
    EXPECT_TRUE(are_same_bits(first, found_by(other, soup, 0.003)));

    OnBoard board(space(), soup);
    CudaGraph graph(space(), "test/graph");
    graph.record([&] { device.search(board.x.view(), board.trajectories(), 0.003); });
    for (int k = 0; k < 2; ++k) {
        graph.launch();
        EXPECT_TRUE(device.complete());
        EXPECT_TRUE(are_same_bits(first, downloaded(device, int(first.size()))));
    }
}

TEST_F(DeviceNearPairsTest, ReorderTheTreesOnlyWhenTheyDegrade)
{
    Random random(37);
    Soup soup;
    for (int layer = 0; layer < 20; ++layer)
        add_sheet(soup, 8, 0.01, 0.01 * layer);
    for (Vec3& x : soup.x)
        x += 1e-4 * random.point();
    NearPairs host(soup.triangles, soup.x);
    DeviceNearPairs device(space(), soup.triangles, soup.x);
    Stages stages;
    const Stages::Activate activate(stages);
    const auto search = [&](const std::string& what) {
        std::vector<NearPair> expected;
        host.find(soup.x, soup.trajectories(), 0.004, expected);
        expect_same(expected, found_by(device, soup, 0.004), what);
        return stages.calls("collision/device_reorder");
    };
    EXPECT_EQ(search("at first"), 0);
    for (Vec3& x : soup.x)
        x = Vec3(x.y(), 10.0 - x.x(), x.z());
    EXPECT_EQ(search("turned"), 0);
    // All vertices scattered: one search detects that the order is inefficient, the next one replaces it.
    for (size_t v = 0; v < soup.x.size(); ++v)
        soup.x[v] += Vec3(0.3 * double((7 * (v / 64)) % 20), 0.5 * double((3 * (v / 64)) % 5), 0);
    EXPECT_EQ(search("scattered"), 0);
    EXPECT_EQ(search("ordered"), 3);
    EXPECT_EQ(search("afterwards"), 3);
}

TEST_F(DeviceNearPairsTest, MatchTheCpuOnAFoldedGarment)
{
    const std::filesystem::path file =
        std::filesystem::path(TOILE_DATA_DIR) / "garments/mh_woman_female_elegantsuit01.obj";
    if (!std::filesystem::exists(file))
        GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no garments/mh_woman_female_elegantsuit01.obj";
    const TriangleMesh garment = read_obj(file).triangulated();
    Soup soup;
    soup.triangles = garment.triangles;
    soup.x = garment.positions;
    soup.stand_still();
    Random random(38);
    for (Vec3& x : soup.x) {
        // Folded in zigzag along the height, layers 2 mm apart.
        const double fold = x.y() / 0.1, layer = std::floor(fold), along = fold - layer;
        x.y() = 0.1 * (int(layer) % 2 == 0 ? along : 1.0 - along);
        x.z() = 0.3 * x.z() + 0.002 * layer;
    }
    compare(soup, 0.002, "at rest");
    for (Vec3& motion : soup.motion)
        motion = 1e-3 * random.point() + Vec3(0, -0.01, 0);
    compare(soup, 0.001, "moving");
    std::cout << "compared " << count() << " pairs of " << soup.x.size() << " vertices\n";
    EXPECT_GT(count(), 10000u);
}

} // namespace
} // namespace toile::test
