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
    const std::string remedy = "give numbers of GPUs with commas between, e.g. 0,1";
    EXPECT_EQ(refused([] { parse_devices(""); }), "--devices: is empty; " + remedy);
    for (const std::string bad : {"x", "-1", "1.5", "0x1", " 1", "99999999999"})
        EXPECT_EQ(refused([&] { parse_devices("0," + bad); }),
                  "--devices: \"" + bad + "\" in \"0," + bad + "\" is no number of a GPU; " + remedy);
    for (const std::string bad : {",", "0,", ",0", "0,,1"})
        EXPECT_EQ(refused([&] { parse_devices(bad); }),
                  "--devices: \"\" in \"" + bad + "\" is no number of a GPU; " + remedy);
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
