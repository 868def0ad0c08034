#include "core/pd/newton/coarse_age.h"

#include <gtest/gtest.h>

namespace toile::test {

namespace {

TEST(CoarseAge, IsOverAtTheStartOfAMinimisation)
{
    CoarseAge age(10);
    EXPECT_TRUE(age.is_over(true));
    age.take(5);
    EXPECT_FALSE(age.is_over(false));
    EXPECT_TRUE(age.is_over(true));
}

TEST(CoarseAge, IsOverOnceItHasCostAsMuchAsANewOne)
{
    CoarseAge age(10);
    EXPECT_TRUE(age.is_over(true));
    for (const int iterations : {5, 11, 3}) { // six too many
        age.take(iterations);
        EXPECT_FALSE(age.is_over(false));
    }
    age.take(9); // four more
    EXPECT_TRUE(age.is_over(false));
    age.take(9); // as many as a young one needs now
    age.take(9);
    EXPECT_FALSE(age.is_over(false));
}

} // namespace

} // namespace toile::test
