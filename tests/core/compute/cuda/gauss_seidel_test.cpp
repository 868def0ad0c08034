#include "core/compute/cuda/scan.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

using DeviceGaussSeidelTest = OnDevice;

/// Device array filled from the host.
template <typename T>
DeviceArray<T> uploaded(const CudaSpace& space, const std::vector<T>& values)
{
    DeviceArray<T> array(space, "test/values");
    array.upload(values);
    return array;
}

/// Bitwise equality, with many more items than threads.
TEST_F(DeviceGaussSeidelTest, MatchesTheSequentialSweep)
{
    for (const auto& [count, shared_count] : {std::pair(1, 20), {700, 60}, {200000, 70000}}) {
        const SharedItems made(count, shared_count);
        const GaussSeidelSchedule order{count};
        const std::vector<unsigned char> listed = some_listed(order);
        std::vector<Vec3> values[] = {some_values(shared_count, 1.0), some_values(shared_count, 500.0)};

        const auto items = uploaded(space(), made.items);
        const auto flags = uploaded(space(), listed);
        const auto list_of = uploaded(space(), made.list_of), first = uploaded(space(), made.first),
                   entries = uploaded(space(), made.entries);
        DeviceArray<Vec3> vectors[] = {uploaded(space(), values[0]), uploaded(space(), values[1])};
        const SharedFields<2> fields{vectors[0].view(), vectors[1].view()};
        DeviceArray<int> slots(space(), "test/places", order.slot_count()),
            listed_count(space(), "test/count", 1);
        DeviceArray<GaussSeidelRank> rank(space(), "test/rank", GaussSeidelState::kSharedSlots * count);
        DeviceArray<TaggedVector> passed(space(), "test/passed", 2 * shared_count);
        DeviceArray<unsigned> next(space(), "test/next", 1);
        next.fill_zero();
        DeviceScratch scratch(space(), "test/scratch");
        list_flagged(space(), "test/list", flags.view(), slots.view(), listed_count.view(), scratch);
        const GaussSeidelState state{order,       slots.view(),  listed_count.view(),
                                     rank.view(), passed.view(), next.view()};
        launch(space(), AssignGaussSeidelRank<SharedByItem, 2>{state,
                                                               {items.view()},
                                                               flags.view(),
                                                               {list_of.view(), first.view(), entries.view()},
                                                               fields,
                                                               rank.view()});
        launch(space(), state, count, MixShared{items.view(), fields});

        mix_sequentially(made, order, listed, {values[0], values[1]});
        EXPECT_EQ(vectors[0].downloaded(), values[0]) << count;
        EXPECT_EQ(vectors[1].downloaded(), values[1]) << count;
    }
}

} // namespace
} // namespace toile::test
