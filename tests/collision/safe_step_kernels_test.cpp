#include "collision/cloth/safe_step_kernels.h"

#include <gtest/gtest.h>

#include "collision/cloth/safe_step.h"
#include "tests/collision/cloth_cases.h"

namespace toile {
namespace {

using test::ClothCase;

/// The first look of DeviceSafeStep, with the same bodies, on the CPU.
class FirstLook {
public:
    FirstLook(const ClothCase& made, NearPairs& near, const LeastGap& gap, std::vector<NearPair> pairs)
        : made_(made), near_(near), gap_(gap), pairs_(std::move(pairs)), known_motion_(made.x.size()),
          known_radius_(made.x.size()), way_(made.x.size()), marks_(made.x.size())
    {
        for_each_vertex(KnowExpected{made.x, made.expected, made.slack, known()});
    }

    bool leaves_alone(const std::vector<Vec3>& x)
    {
        const CountStrays count{made_.x, x, known(), way_, marks_};
        strays_ = 0;
        for (int v = 0; v < int(x.size()); ++v)
            strays_ += count(v);
        if (any_in_the_way(pairs_))
            return false;
        for_each_vertex(KnowStrays{marks_, way_, made_.slack, known()});
        std::vector<NearPair> more;
        near_.find(made_.x, {known_motion_, known_radius_, marks_}, gap_.most(), more);
        return !any_in_the_way(more);
    }
    int strays() const { return strays_; }

private:
    KnownWays known() { return {known_motion_, known_radius_}; }
    template <typename Kernel>
    void for_each_vertex(const Kernel& kernel) const
    {
        for (int v = 0; v < int(made_.x.size()); ++v)
            kernel(v);
    }
    bool any_in_the_way(const std::vector<NearPair>& pairs) const
    {
        std::vector<unsigned char> flags(pairs.size());
        const CountInTheWay count{pairs, {made_.x, way_, gap_}, {}, 0, flags};
        int sum = 0;
        for (int i = 0; i < int(pairs.size()); ++i)
            sum += count(i);
        return sum > 0;
    }

    const ClothCase& made_;
    NearPairs& near_;
    LeastGap gap_;
    std::vector<NearPair> pairs_;
    std::vector<Vec3> known_motion_;
    std::vector<double> known_radius_;
    std::vector<Vec3> way_;
    std::vector<unsigned char> marks_;
    int strays_ = 0;
};

TEST(SafeStepKernels, LeaveAloneWhatSafeStepDoes)
{
    test::Random random(51);
    int alone = 0, held = 0, strayed = 0;
    for (int trial = 0; trial < 60; ++trial) {
        const ClothCase made = random_cloth_case(random);
        NearPairs near(made.triangles, made.x);
        const ExemptPairs exempt(made.x, std::vector<double>(made.x.size(), 0.01), 2e-6);
        SafeStep safe(near, exempt, {});
        std::vector<Vec3> motion(made.x.size());
        for (size_t v = 0; v < motion.size(); ++v)
            motion[v] = made.expected[v] - made.x[v];
        std::vector<NearPair> pairs;
        near.find(made.x, {motion, made.slack}, SafeStep::Settings{}.thickness, pairs);
        const std::vector<unsigned char> free(made.x.size(), 0);
        safe.begin(made.x, made.expected, made.slack, free, pairs);

        std::vector<Vec3> x = made.wanted;
        const bool is_free = safe.limit(x) == 0.0;
        EXPECT_EQ(is_free, x == made.wanted);
        FirstLook look(made, near, safe.least_gap(), pairs);
        EXPECT_EQ(look.leaves_alone(made.wanted), is_free) << trial;
        EXPECT_TRUE(look.leaves_alone(made.x)) << trial;
        (is_free ? alone : held)++;
        strayed += is_free && look.strays() > 0;
    }
    EXPECT_GE(alone, 15);
    EXPECT_GE(held, 15);
    EXPECT_GE(strayed, 5);
}

} // namespace
} // namespace toile
