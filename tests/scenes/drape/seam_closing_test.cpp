#include "scenes/drape/seam_closing.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>

#include "scenes/garment_format/read_garment.h"
#include "tests/scenes/drape/tube_pattern.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

namespace {

class SeamClosingTest : public ::testing::Test {
protected:
    SeamClosingTest()
    {
        const std::filesystem::path file = folder_.path() / "tube.json";
        std::ofstream(file) << tube(0.2, "");
        pattern_ = garment_format::read_pattern(file);
        mesh_.emplace(pattern_, 0.05);
        // Every vertex in a place of its own, 1 m apart.
        for (int v = 0; v < mesh_->panels.vertex_count(); ++v)
            apart_.emplace_back(double(v), 0.0, 0.0);
    }

    /// Positions in which the threads of a seam have the given lengths.
    std::vector<Vec3> with_gaps(size_t seam, const std::vector<double>& gaps) const
    {
        std::vector<Vec3> x = apart_;
        for (size_t i = 0; i < gaps.size(); ++i) {
            const auto [a, b] = mesh_->panels.stitches[seam][i];
            x[size_t(b)] = x[size_t(a)] + Vec3(0.0, gaps[i], 0.0);
        }
        return x;
    }

    TemporaryFolder folder_;
    garment::Pattern pattern_;
    std::optional<GarmentMesh> mesh_;
    std::vector<Vec3> apart_;
};

TEST_F(SeamClosingTest, WeldsTheShortThreadsOfASeamAndKeepsTheOthers)
{
    const size_t threads = mesh_->panels.stitches[0].size();
    ASSERT_EQ(threads, 5u); // 20 cm by 5 cm
    SeamClosing seams(*mesh_, apart_);
    const size_t vertices = seams.surface().mesh.positions.size();
    EXPECT_EQ(vertices, apart_.size());
    EXPECT_EQ(seams.surface().mesh.lines.size(), 2 * threads);

    seams.move(with_gaps(0, {0.001, 0.5, 0.0019, 0.0021, 0.0005}));
    EXPECT_FALSE(seams.can_weld());
    EXPECT_EQ(seams.weld(), 3);
    EXPECT_EQ(seams.surface().mesh.positions.size(), vertices - 3);
    EXPECT_EQ(seams.surface().mesh.lines.size(), 2 * threads - 3);
    EXPECT_FALSE(seams.are_closed());
    EXPECT_NEAR(seams.gaps()[0], 0.5, 1e-12); // of the threads that are open

    // Both ends of a welded thread are halfway, and move together.
    const auto [a, b] = mesh_->panels.stitches[0][0];
    EXPECT_EQ(seams.positions()[size_t(a)], seams.positions()[size_t(b)]);
    EXPECT_NEAR(seams.positions()[size_t(a)].y(), 0.0005, 1e-12);
}

TEST_F(SeamClosingTest, ClosesInRoundsAndTellsTheWidestThreadThatWasWelded)
{
    SeamClosing seams(*mesh_, apart_);
    for (const size_t seam : {size_t(0), size_t(1)}) {
        std::vector<Vec3> x = seams.positions();
        for (const auto& [a, b] : mesh_->panels.stitches[seam])
            x[size_t(b)] = x[size_t(a)] + Vec3(0.0, seam == 0 ? 0.0015 : 0.0004, 0.0);
        // The surface's vertices are those of the panels, or their means where a seam is welded.
        const auto partly = garment::sewn_mesh([&] {
            garment::PatternMesh panels = mesh_->panels;
            if (seam == 0)
                panels.stitches[0].clear();
            panels.stitches[1].clear();
            return panels;
        }());
        seams.move(weld(partly, x));
        EXPECT_EQ(seams.weld(), int(mesh_->panels.stitches[seam].size()));
    }
    EXPECT_TRUE(seams.are_closed());
    EXPECT_TRUE(seams.can_weld());
    EXPECT_EQ(seams.open_length(), 0.0);
    EXPECT_NEAR(seams.gaps()[0], 0.0015, 1e-12);
    EXPECT_NEAR(seams.gaps()[1], 0.0004, 1e-12);
    const ObjMesh closed = seams.surface().mesh;
    EXPECT_TRUE(closed.lines.empty());
    EXPECT_EQ(int(closed.positions.size()), mesh_->sewn.vertex_count);
    EXPECT_EQ(closed.groups.size(), 2u);
}

TEST_F(SeamClosingTest, SewsSeamsOfALowerOrderFirst)
{
    const size_t first = mesh_->panels.stitches[1].size(), last = mesh_->panels.stitches[0].size();
    SeamClosing seams(*mesh_, apart_, {7, 2});
    EXPECT_EQ(seams.surface().mesh.lines.size(), first) << "only these pull";
    EXPECT_EQ(seams.widest(), 1);

    // The last seam closes by itself, and waits for the first all the same.
    std::vector<double> gaps(last, 0.001);
    seams.move(with_gaps(0, gaps));
    EXPECT_FALSE(seams.can_weld());
    EXPECT_EQ(seams.weld(), 0);

    // Half of the first seam: the last one waits on.
    std::vector<Vec3> x = seams.positions();
    for (size_t i = 0; i < first; ++i) {
        const auto [a, b] = mesh_->panels.stitches[1][i];
        x[size_t(b)] = x[size_t(a)] + Vec3(0.0, i < 2 ? 0.001 : 0.5, 0.0);
    }
    seams.move(x);
    EXPECT_EQ(seams.weld(), 2);
    EXPECT_EQ(seams.surface().mesh.lines.size(), first - 2);

    x = seams.positions();
    for (const auto& [a, b] : mesh_->panels.stitches[1])
        x[size_t(b)] = x[size_t(a)];
    garment::PatternMesh partly = mesh_->panels;
    partly.stitches[0].clear();
    partly.stitches[1] = {mesh_->panels.stitches[1][0], mesh_->panels.stitches[1][1]};
    seams.move(weld(garment::sewn_mesh(partly), x));
    EXPECT_TRUE(seams.can_weld());
    EXPECT_EQ(seams.weld(), int(first) - 2);
    EXPECT_FALSE(seams.are_closed());
    EXPECT_EQ(seams.widest(), 0);
    EXPECT_EQ(seams.surface().mesh.lines.size(), last) << "now the others pull";
    EXPECT_GT(seams.weld(), 0);
}

TEST(SeamOrder, PutsSeamsOfOnePanelBeforeOthersOfTheirOrder)
{
    const auto between = [](int order, int a, int b) {
        garment::Seam seam;
        seam.order = order;
        seam.a.emplace_back().panel = a;
        seam.b.emplace_back().panel = b;
        return seam;
    };
    garment::Pattern pattern;
    pattern.seams = {between(0, 0, 1), between(0, 2, 2), between(1, 3, 3), between(1, 0, 3)};
    const std::vector<int> order = orders_of(pattern);
    EXPECT_LT(order[1], order[0]);
    EXPECT_LT(order[0], order[2]);
    EXPECT_LT(order[2], order[3]);

    pattern.seams[1].b.emplace_back().panel = 0; // goes on to another panel
    EXPECT_EQ(orders_of(pattern)[1], orders_of(pattern)[0]);
}

} // namespace

} // namespace toile::test
