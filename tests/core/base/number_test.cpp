#include "core/base/number.h"

#include <gtest/gtest.h>

#include <clocale>
#include <limits>

namespace toile::test {

namespace {

TEST(ShortText, HasThreeDigitsInEveryLocale)
{
    const char* const german = std::setlocale(LC_NUMERIC, "de_DE.UTF-8"); // where it is installed
    EXPECT_EQ(short_text(0.0), "0");
    EXPECT_EQ(short_text(60.0), "60");
    EXPECT_EQ(short_text(0.60004), "0.6");
    EXPECT_EQ(short_text(-1.2345), "-1.23");
    EXPECT_EQ(short_text(0.00005), "5e-05");
    EXPECT_EQ(short_text(12345.0), "1.23e+04");
    if (german != nullptr)
        std::setlocale(LC_NUMERIC, "C");
}

TEST(ShortestText, ReadsBackAsTheSameNumber)
{
    EXPECT_EQ(shortest_text(0.1), "0.1");
    EXPECT_EQ(shortest_text(1.0 / 3.0), "0.3333333333333333");
    EXPECT_EQ(shortest_text(1.0f / 3.0f), "0.33333334");
    EXPECT_EQ(shortest_text(-0.0), "-0");
    EXPECT_EQ(shortest_text(-std::numeric_limits<double>::quiet_NaN()), "nan");
    EXPECT_EQ(shortest_text(-std::numeric_limits<float>::infinity()), "-inf");
}

} // namespace
} // namespace toile::test
