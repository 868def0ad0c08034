#include "core/base/long_work.h"

#include <algorithm>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/mesh/obj.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

namespace {

TEST(LongWork, ScalesTheFractionsOfItsParts)
{
    std::vector<double> told;
    {
        const LongWork::Scope scope(
            [&](const LongWork::Progress& progress) { told.push_back(progress.fraction); });
        {
            const LongWork::Part half(0.0, 0.5);
            const LongWork::Part second = LongWork::item(1, 2);
            LongWork::update(0.0);
            LongWork::update(0.5);
        }
        LongWork::update(0.75);
    }
    EXPECT_EQ(told, (std::vector<double>{0.25, 0.375, 0.75}));
    const LongWork::Part unheard(0.0, 0.5);
    LongWork::update(1.0);
    EXPECT_EQ(told.size(), 3u);
}

class LongFile : public FileTest {
protected:
    LongFile()
    {
        std::string text;
        for (int line = 0; line < 50'000; ++line)
            text += "v 0 " + std::to_string(line) + " 0\n";
        temporary_.write("long.obj", text);
    }
};

TEST_F(LongFile, TellsHowFarItIsRead)
{
    std::vector<double> told;
    const LongWork::Scope scope(
        [&](const LongWork::Progress& progress) { told.push_back(progress.fraction); });
    EXPECT_EQ(read_obj(file("long.obj")).positions.size(), 50'000u);
    EXPECT_GE(told.size(), 5u);
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LT(told.front(), 0.01);
    EXPECT_LT(told.back(), 1.0);
}

TEST_F(LongFile, IsLeftWhereItsReaderShallEnd)
{
    int asked = 0;
    const std::function<bool()> goes_on = [&] { return ++asked < 3; };
    const Cancellation::Scope cancellation(goes_on);
    EXPECT_THROW(read_obj(file("long.obj")), Cancelled);
    EXPECT_EQ(asked, 3);
}

} // namespace
} // namespace toile::test
