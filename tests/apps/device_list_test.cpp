#include "apps/toile/device_list.h"

#include <gtest/gtest.h>

#include "core/backend/error.h"

namespace toile {
namespace {

std::string refused(const std::function<void()>& action)
{
    try {
        action();
    } catch (const InvalidInput& error) {
        return error.what();
    }
    return "";
}

TEST(DeviceList, KeepsTheOrder)
{
    EXPECT_EQ(parse_devices("0"), std::vector<int>({0}));
    EXPECT_EQ(parse_devices("3,0,12"), std::vector<int>({3, 0, 12}));
}

TEST(DeviceList, RefusesWhatIsNoNumber)
{
    EXPECT_EQ(refused([] { parse_devices(""); }),
              "--devices: is empty; give numbers of GPUs with commas between, e.g. 0,1");
    EXPECT_EQ(
        refused([] { parse_devices("0,x"); }),
        R"(--devices: "x" in "0,x" is no number of a GPU; give numbers of GPUs with commas between, e.g. 0,1)");
    for (const char* bad : {"-1", "0,1.5", "0x1", " 1", "99999999999", ",", "0,", ",0", "0,,1"})
        EXPECT_NE(refused([&] { parse_devices(bad); }).find("is no number of a GPU"), std::string::npos)
            << bad;
}

TEST(DeviceList, RefusesTheSameNumberTwice)
{
    EXPECT_EQ(refused([] { parse_devices("1,0,1"); }),
              "--devices: 1 is there twice in \"1,0,1\"; name each GPU once");
}

TEST(DeviceList, RefusesWhatTheMachineDoesNotHave)
{
    const std::vector<CudaDevice> there{{0, "Card A", 1, 1, 9, 0}, {1, "Card B", 1, 1, 9, 0}};
    EXPECT_EQ(refused([&] { require_devices({1, 0}, there); }), "");
    EXPECT_EQ(refused([&] {
                  require_devices({0, 2, 5}, there);
              }),
              "--devices: there is no GPU 2; this machine has 2: 0 (Card A), 1 (Card B)");
}

} // namespace
} // namespace toile
