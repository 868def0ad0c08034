#include "apps/toile/simulate/device_list.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/compute/cuda/runtime/device.h"

namespace toile::test {

using namespace app;

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

TEST(DeviceList, RefusesWordsThatAreNoNumber)
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
              "--devices: 1 appears twice in \"1,0,1\"; name each GPU once");
}

TEST(DeviceList, RefusesMissingDevices)
{
    const std::vector<CudaDevice> available{{0, "Card A", 1, 1, 9, 0}, {1, "Card B", 1, 1, 9, 0}};
    EXPECT_EQ(refused([&] { require_devices({1, 0}, available); }), "");
    EXPECT_EQ(refused([&] {
                  require_devices({0, 2, 5}, available);
              }),
              "--devices: there is no GPU 2; this machine has 2: 0 (Card A), 1 (Card B)");
}

} // namespace
} // namespace toile::test
