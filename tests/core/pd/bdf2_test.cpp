#include "core/pd/step/bdf2.h"

#include <vector>

#include <gtest/gtest.h>

namespace toile::test {

namespace {

/// All of a part that nothing touched before begins to touch; of one that something touched, and outside of
/// parts, each vertex does so by itself.
TEST(MotionView, BeginsToTouchByStiffParts)
{
    std::vector<Vec3> field(6, Vec3::Zero());
    std::vector<unsigned char> restart(6, 0), fixed(6, 0);
    std::vector<unsigned char> touched{0, 0, 1, 0, 0, 0}, touches{1, 0, 1, 1, 0, 1};
    std::vector<int> part{0, 0, 1, 1, 1, -1};
    std::vector<unsigned char> part_touched(2, 0), part_touches(2, 0);
    MotionView motion{field,   field, field, field,        restart,     touched,
                      touches, fixed, part,  part_touched, part_touches};
    const auto begun = [&] {
        std::vector<int> begun;
        for (int i = 0; i < 6; ++i)
            if (motion.has_begun_to_touch(i))
                begun.push_back(i);
        return begun;
    };
    EXPECT_EQ(begun(), (std::vector<int>{0, 3, 5}));
    for (int i = 0; i < 6; ++i)
        MarkPart{motion}(i);
    EXPECT_EQ(begun(), (std::vector<int>{0, 1, 3, 5}));
    motion.stiff_part = {};
    EXPECT_EQ(begun(), (std::vector<int>{0, 3, 5}));
}

} // namespace
} // namespace toile::test
