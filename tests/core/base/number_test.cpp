#include "core/base/number.h"

#include <gtest/gtest.h>

#include <clocale>

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

} // namespace
} // namespace toile::test
