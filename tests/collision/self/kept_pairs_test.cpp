#include "collision/self/kept_pairs.h"

#include <algorithm>
#include <tuple>

#include <gtest/gtest.h>

#include "collision/self/near_pairs.h"
#include "core/base/stages.h"
#include "tests/collision/soups.h"

namespace toile::test {

using namespace collision;

namespace {

using test::folded_sheet;
using test::Random;
using test::Soup;

constexpr double kMargin = 2e-4, kEdge = 0.01;

/// Pairs found by a new NearPairs, which performs a full search. Outside the counted stages.
std::vector<NearPair> find_anew(const Soup& soup, const Trajectories& trajectories, double margin,
                                const std::vector<int>& rigid = {})
{
    Stages aside;
    const Stages::Activate activate(aside);
    std::vector<NearPair> pairs;
    NearPairs(soup.triangles, soup.x, rigid).find(soup.x, trajectories, margin, pairs);
    return pairs;
}

void expect_same_bits(const std::vector<NearPair>& a, const std::vector<NearPair>& b)
{
    ASSERT_EQ(a.size(), b.size());
    int different = 0;
    for (size_t i = 0; i < a.size(); ++i)
        different +=
            std::tie(a[i].vertex, a[i].weight, a[i].distance, a[i].first, a[i].second, a[i].is_edge_edge,
                     a[i].is_facing) != std::tie(b[i].vertex, b[i].weight, b[i].distance, b[i].first,
                                                 b[i].second, b[i].is_edge_edge, b[i].is_facing) ||
            a[i].normal != b[i].normal;
    EXPECT_EQ(different, 0);
}

/// Layers with small motions relative to the common one, larger for some vertices.
class KeptPairsOfLayers : public testing::Test {
protected:
    KeptPairsOfLayers()
        : soup_(folded_sheet(random_)), near_(soup_.triangles, soup_.x), marks_(soup_.x.size(), 0)
    {
        soup_.stand_still();
    }

    /// @param usual  [m] max relative motion of a vertex, before and within the step
    /// @param out_of_bounds  [-] fraction of vertices that move by up to an edge
    void move(double usual, double out_of_bounds)
    {
        const Vec3 all = 0.1 * random_.point(), all_go = 0.1 * random_.point();
        for (size_t v = 0; v < soup_.x.size(); ++v) {
            const double max_excursion = random_.uniform(0, 1) < out_of_bounds ? kEdge : usual;
            soup_.x[v] += all + max_excursion * random_.uniform(0, 1) * random_.point();
            soup_.motion[v] = all_go + max_excursion * random_.uniform(0, 1) * random_.point();
            soup_.slack[v] = random_.below(3) == 0 ? usual * random_.uniform(0, 1) : 0.0;
            marks_[v] = (unsigned char)(random_.below(10) == 0);
        }
    }

    void expect_all(const Trajectories& trajectories, double margin)
    {
        near_.find(soup_.x, trajectories, margin, found_);
        expect_same_bits(found_, find_anew(soup_, trajectories, margin));
        count_ += found_.size();
    }

    Random random_{31};
    Soup soup_;
    NearPairs near_;
    std::vector<unsigned char> marks_;
    std::vector<NearPair> found_;
    size_t count_ = 0;
    Stages stages_;
    Stages::Activate activate_{stages_};
};

TEST_F(KeptPairsOfLayers, MatchAFullSearch)
{
    for (const double usual : {1e-5, 1e-4, 4e-4})
        for (int i = 0; i < 20; ++i) {
            move(usual, i % 4 == 3 ? 0.01 : 0.0);
            expect_all(soup_.trajectories(), kMargin);
            expect_all({soup_.motion, soup_.slack, marks_}, 0.5 * kMargin);
            expect_all({{}, {}, marks_}, 0.0);
        }
    EXPECT_GT(count_, 5000u);
    EXPECT_GT(stages_.calls("collision/cloth_kept"), 60);
    EXPECT_GT(stages_.calls("collision/cloth_keep"), 2);
}

TEST_F(KeptPairsOfLayers, NeedNoSearchWithoutOutOfBoundsVertices)
{
    for (int i = 0; i < 2; ++i) // the first search, and the one that finds static cloth
        expect_all(soup_.trajectories(), kMargin);
    EXPECT_EQ(stages_.calls("collision/cloth_keep"), 1);
    for (int i = 0; i < 5; ++i) {
        move(1e-5, 0.0);
        stages_.clear();
        near_.find(soup_.x, soup_.trajectories(), kMargin, found_);
        near_.find(soup_.x, {soup_.motion, soup_.slack, marks_}, kMargin, found_);
        EXPECT_EQ(stages_.calls("collision/cloth_kept"), 2);
        EXPECT_EQ(stages_.calls("collision/cloth_pairs"), 0);
        EXPECT_EQ(stages_.calls("collision/cloth_refit"), 0);
    }
}

TEST_F(KeptPairsOfLayers, AreNotKeptWhenClothMovesFast)
{
    for (int i = 0; i < 10; ++i) {
        move(kEdge, 0.0);
        expect_all(soup_.trajectories(), kMargin);
    }
    EXPECT_EQ(stages_.calls("collision/cloth_keep"), 0);
    EXPECT_EQ(stages_.calls("collision/cloth_kept"), 0);
}

/// A fast body meets cloth that moves no more than the rest.
TEST_F(KeptPairsOfLayers, IncludeThoseOfFastBodiesWithSlowCloth)
{
    std::vector<int> rigid(soup_.x.size(), -1);
    for (size_t v = 0; v < rigid.size(); v += 2)
        rigid[v] = kPrescribed;
    NearPairs near(soup_.triangles, soup_.x, rigid);
    size_t of_fast_bodies = 0;
    for (int i = 0; i < 20; ++i) {
        move(1e-5, 0.0);
        std::vector<unsigned char> is_fast(rigid.size(), 0);
        for (int k = 0; k < 10; ++k) {
            const int v = 2 * random_.below(int(rigid.size() / 2));
            is_fast[v] = 1;
            soup_.motion[v] += kEdge * random_.point();
        }
        near.find(soup_.x, soup_.trajectories(), kMargin, found_);
        expect_same_bits(found_, find_anew(soup_, soup_.trajectories(), kMargin, rigid));
        for (const NearPair& pair : found_)
            of_fast_bodies +=
                std::any_of(pair.vertex.begin(), pair.vertex.end(), [&](int v) { return is_fast[v] != 0; });
    }
    EXPECT_GT(of_fast_bodies, 100u);
    EXPECT_GT(stages_.calls("collision/cloth_kept"), 10);
}

/// Collapsed and repeated triangles, rigid bodies, margins that grow after a list was made.
TEST(KeptPairs, MatchAFullSearchInRandomSoups)
{
    constexpr double kSoupMargin = 0.01;
    Random random(32);
    Stages stages;
    const Stages::Activate activate(stages);
    size_t count = 0;
    for (int i = 0; i < 10; ++i) {
        Soup soup = test::random_soup(random);
        std::vector<int> rigid(soup.x.size(), -1);
        for (int v = 0; v < 20; ++v)
            rigid[v] = v / 10;
        NearPairs near(soup.triangles, soup.x, rigid);
        std::vector<NearPair> found;
        for (const double margin : {1.0, 1.0, 0.5, 2.0, 8.0, 40.0, 0.0, 1.0}) {
            near.find(soup.x, soup.trajectories(), margin * kSoupMargin, found);
            expect_same_bits(found, find_anew(soup, soup.trajectories(), margin * kSoupMargin, rigid));
            count += found.size();
            for (size_t v = 0; v < soup.x.size(); ++v) {
                soup.x[v] += 1e-3 * random.point();
                soup.motion[v] = 2e-3 * random.point();
                soup.slack[v] *= 0.1;
            }
        }
    }
    EXPECT_GT(count, 10000u);
    EXPECT_GT(stages.calls("collision/cloth_kept"), 30);
}

/// Stages of sixty searches while `layers` sheets rotate.
Stages stages_of_rotating_sheets(int layers)
{
    Soup soup;
    for (int layer = 0; layer < layers; ++layer)
        test::add_sheet(soup, 8, kEdge, 2.5 * kMargin * layer);
    NearPairs near(soup.triangles, soup.x);
    Stages stages;
    const Stages::Activate activate(stages);
    std::vector<NearPair> found;
    for (int i = 0; i < 60; ++i) {
        for (Vec3& x : soup.x)
            x.y() += 0.01 * x.x();
        near.find(soup.x, soup.trajectories(), kMargin, found);
        expect_same_bits(found, find_anew(soup, soup.trajectories(), kMargin));
    }
    return stages;
}

TEST(KeptPairs, AreRebuiltWhenClothMovesOn)
{
    const Stages stages = stages_of_rotating_sheets(2);
    EXPECT_GT(stages.calls("collision/cloth_keep"), 2);
    EXPECT_LT(stages.calls("collision/cloth_pairs"), 20) << "each list serves several";
}

/// In a deep stack every layer is near many others, and testing a list costs as much as a search.
TEST(KeptPairs, AreNotRetriedSoonInDeepStacks)
{
    EXPECT_EQ(stages_of_rotating_sheets(20).calls("collision/cloth_keep"), 1);
}

TEST(KeptPairs, AreNotTriedWithoutAMargin)
{
    Soup soup;
    test::add_sheet(soup, 8, kEdge, 0.0);
    NearPairs near(soup.triangles, soup.x);
    Stages stages;
    const Stages::Activate activate(stages);
    std::vector<NearPair> found;
    for (int i = 0; i < 5; ++i)
        near.find(soup.x, soup.trajectories(), 0.0, found);
    EXPECT_EQ(stages.calls("collision/cloth_pairs"), 5);
}

/// Corners of a triangle and the vertex above it. The past motion of one corner and the future motion of
/// another are each within the limit of a side; their sum is not.
TEST(KeptPairs, AreOutOfBoundsWhenTheTotalMotionOfASideIsTooLarge)
{
    const std::vector<Vec3> x{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0.3, 0.1, 0.3)};
    constexpr double kWide = 0.1;
    KeptPairs kept(1.0);
    const double reach = 0.5 * (kept.wide(kWide) - kWide);
    ASSERT_GT(reach, 0.1);
    kept.plan(x, {}, kWide);
    kept.change_vertex_triangle() = {{{3, 0}, 0.1}};
    kept.keep(x, {}, kWide);
    EXPECT_FALSE(kept.has_out_of_bounds());

    std::vector<Vec3> moved = x, motion(4, Vec3::Zero());
    moved[0].y() += 0.8 * reach;
    moved[1].y() -= 0.8 * reach;
    motion[2].y() = 0.8 * reach;
    motion[3].y() = -0.8 * reach;
    kept.plan(moved, {motion, {}}, kWide);
    EXPECT_TRUE(kept.has_out_of_bounds());
}

} // namespace
} // namespace toile::test
