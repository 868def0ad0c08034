#include "collision/ccd/collision_free_step_kernels.h"

#include <gtest/gtest.h>

#include "collision/ccd/collision_free_step.h"
#include "tests/collision/cloth_cases.h"

namespace toile::test {

using namespace collision;

namespace {

using test::ClothCase;

/// First query of DeviceCollisionFreeStep: its kernels, run on the CPU.
class FirstQuery {
public:
    FirstQuery(const ClothCase& made, NearPairs& near, const MinGap& gap, std::vector<NearPair> pairs)
        : made_(made), near_(near), gap_(gap), pairs_(std::move(pairs)), known_motion_(made.x.size()),
          known_radius_(made.x.size()), displacement_(made.x.size()), marks_(made.x.size())
    {
        for_each_vertex(RecordExpected{made.x, made.expected, made.slack, known()});
    }

    bool leaves_alone(const std::vector<Vec3>& x)
    {
        const MarkOutOfBounds count{made_.x, x, known(), displacement_, marks_};
        out_of_bounds_ = 0;
        for (int v = 0; v < int(x.size()); ++v)
            out_of_bounds_ += count(v);
        if (any_blocked(pairs_))
            return false;
        for_each_vertex(WidenKnown{marks_, displacement_, made_.slack, known()});
        std::vector<NearPair> more;
        near_.find(made_.x, {known_motion_, known_radius_, marks_}, gap_.largest(), more);
        return !any_blocked(more);
    }
    int out_of_bounds() const { return out_of_bounds_; }

private:
    KnownTrajectories known() { return {known_motion_, known_radius_}; }
    template <typename Kernel>
    void for_each_vertex(const Kernel& kernel) const
    {
        for (int v = 0; v < int(made_.x.size()); ++v)
            kernel(v);
    }
    bool any_blocked(const std::vector<NearPair>& pairs) const
    {
        std::vector<unsigned char> flags(pairs.size());
        const CountBlocked count{pairs, {made_.x, displacement_, gap_}, {}, 0, flags};
        int sum = 0;
        for (int i = 0; i < int(pairs.size()); ++i)
            sum += count(i);
        return sum > 0;
    }

    const ClothCase& made_;
    NearPairs& near_;
    MinGap gap_;
    std::vector<NearPair> pairs_;
    std::vector<Vec3> known_motion_;
    std::vector<double> known_radius_;
    std::vector<Vec3> displacement_;
    std::vector<unsigned char> marks_;
    int out_of_bounds_ = 0;
};

TEST(CollisionFreeStepKernels, AcceptTheSameStepsAsCollisionFreeStep)
{
    test::Random random(51);
    int alone = 0, held = 0, out_of_bounds_cases = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const ClothCase made = random_cloth_case(random);
        NearPairs near(made.triangles, made.x);
        const ExemptPairs exempt(made.x, std::vector<double>(made.x.size(), 0.01), 2e-6);
        CollisionFreeStep free_step(near, exempt, {});
        std::vector<Vec3> motion(made.x.size());
        for (size_t v = 0; v < motion.size(); ++v)
            motion[v] = made.expected[v] - made.x[v];
        std::vector<NearPair> pairs;
        near.find(made.x, {motion, made.slack}, CollisionFreeStep::Settings{}.thickness, pairs);
        const std::vector<unsigned char> free(made.x.size(), 0);
        free_step.begin(made.x, made.expected, made.slack, free, pairs);

        std::vector<Vec3> x = made.wanted;
        const bool is_free = free_step.limit(x) == 0.0;
        EXPECT_EQ(is_free, x == made.wanted);
        FirstQuery query(made, near, free_step.min_gap(), pairs);
        EXPECT_EQ(query.leaves_alone(made.wanted), is_free) << trial;
        EXPECT_TRUE(query.leaves_alone(made.x)) << trial;
        (is_free ? alone : held)++;
        out_of_bounds_cases += is_free && query.out_of_bounds() > 0;
    }
    EXPECT_GE(alone, 15);
    EXPECT_GE(held, 15);
    EXPECT_GE(out_of_bounds_cases, 5);
}

} // namespace
} // namespace toile::test
