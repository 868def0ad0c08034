#include "core/compute/cuda/runtime/graph.h"

#include <iostream>
#include <stdexcept>

#include "core/base/error.h"
#include "core/base/stages.h"
#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

namespace {

/// sum += factor * term, recorded or not.
class CudaGraphTest : public OnDevice {
protected:
    void SetUp() override
    {
        OnDevice::SetUp();
        if (IsSkipped())
            return;
        term_ = std::make_unique<DeviceArray<double>>(space(), "test/term");
        sum_ = std::make_unique<DeviceArray<double>>(space(), "test/sum", kCount);
        term_->upload(std::vector<double>(kCount, 1.0));
        sum_->fill_zero();
    }
    void add(double factor) const { launch(space(), AddScaled{term_->view(), factor, sum_->view()}); }
    void expect_sum(double value) const { EXPECT_EQ(sum_->downloaded(), std::vector<double>(kCount, value)); }
    DeviceArray<double>& sum() const { return *sum_; }

    static constexpr int kCount = 1000;

private:
    std::unique_ptr<DeviceArray<double>> term_, sum_;
};

TEST_F(CudaGraphTest, RunsRecordedWorkOnlyWhenLaunched)
{
    CudaGraph graph(space(), "test/graph");
    graph.record([&] {
        EXPECT_TRUE(space().is_recording());
        add(2.0);
        add(3.0);
    });
    EXPECT_FALSE(space().is_recording());
    EXPECT_EQ(graph.node_count(), 2);
    expect_sum(0.0);
    EXPECT_EQ(allocations_of([&] {
                  for (int i = 0; i < 100; ++i)
                      graph.launch();
              }),
              0);
    expect_sum(500.0);
    EXPECT_EQ(graph.instantiations(), 1);
}

TEST_F(CudaGraphTest, IsUpdatedWhenTheTopologyStays)
{
    CudaGraph graph(space(), "test/graph");
    graph.record([&] { add(2.0); });
    graph.launch();
    for (int i = 0; i < 5; ++i) {
        graph.record([&] { add(10.0 + i); });
        graph.launch();
    }
    expect_sum(2.0 + 10.0 + 11.0 + 12.0 + 13.0 + 14.0);
    EXPECT_EQ(graph.instantiations(), 1);
    EXPECT_EQ(graph.updates(), 5);
}

TEST_F(CudaGraphTest, IsReinstantiatedWhenTheTopologyChanges)
{
    CudaGraph graph(space(), "test/graph");
    graph.record([&] { add(1.0); });
    graph.launch();
    graph.record([&] {
        sum().fill_zero();
        add(5.0);
        add(7.0);
    });
    EXPECT_EQ(graph.node_count(), 3);
    graph.launch();
    graph.launch();
    expect_sum(12.0);
    EXPECT_EQ(graph.instantiations(), 2);
    EXPECT_EQ(graph.updates(), 0);
}

TEST_F(CudaGraphTest, RecordsSumsAndCopies)
{
    PinnedArray<double> value(space(), "test/value", 1);
    DeviceArray<double> slot(space(), "test/slot", 1), block_sums(space(), "test/block_sums", 16);
    CudaGraph graph(space(), "test/graph");
    graph.record([&] {
        add(1.0);
        sum_into(space(), sum().view(), slot.view(), block_sums);
        slot.download(value.view());
    });
    for (int i = 1; i <= 10; ++i) {
        graph.launch();
        space().synchronise();
        EXPECT_EQ(value[0], double(i * kCount));
    }
}

TEST_F(CudaGraphTest, IsUnchangedWhenRecordingFails)
{
    CudaGraph graph(space(), "test/graph");
    graph.record([&] { add(1.0); });
    EXPECT_THROW(graph.record([&] {
        add(100.0);
        throw std::runtime_error("stop");
    }),
                 std::runtime_error);
    EXPECT_FALSE(space().is_recording());
    graph.launch();
    expect_sum(1.0);
}

TEST_F(CudaGraphTest, RefusesWorkThatCannotBeRecorded)
{
    CudaGraph graph(space(), "test/graph"), inner(space(), "test/inner");
    graph.record([&] { add(1.0); });

    std::string message = message_of<DeviceError>([&] { graph.record([&] { sum().resize(1 << 20); }); });
    EXPECT_TRUE(contains_in_order(message, "'test/sum' would have to grow from 8000 to 8388608 bytes",
                                  "while a graph is recorded"))
        << message;
    sum().resize(kCount); // its size was lost, not its memory

    message = message_of<DeviceError>([&] { graph.record([&] { space().synchronise(); }); });
    EXPECT_TRUE(
        contains_in_order(message, "graph_test.cpp:", "nothing can be waited for while a graph is recorded"))
        << message;

    message = message_of<DeviceError>([&] { graph.record([&] { inner.record([] {}); }); });
    EXPECT_TRUE(contains_in_order(message, "graph 'test/inner' can't be recorded while another is"))
        << message;

    EXPECT_FALSE(space().is_recording());
    graph.launch();
    expect_sum(1.0);
}

/// The library cannot forbid allocations outside it: they break the recording, with an error.
TEST_F(CudaGraphTest, ReportsABrokenRecording)
{
    CudaGraph graph(space(), "test/graph");
    const std::string message = message_of<DeviceError>([&] {
        graph.record([&] {
            add(1.0);
            static_cast<void>(cuda::wait_for(0, space().stream()));
        });
    });
    std::cout << message << "\n";
    EXPECT_TRUE(contains_in_order(message, "recording graph 'test/graph' on CUDA device 0 (", "): "))
        << message;
    EXPECT_FALSE(space().is_recording());
    add(3.0);
    expect_sum(3.0);
}

TEST_F(CudaGraphTest, IsOneCallOfItsStage)
{
    CudaGraph graph(space(), "test/graph");
    Stages stages;
    const Stages::Activate activate(stages);
    graph.launch(); // nothing recorded yet
    graph.record([&] { add(1.0); });
    graph.launch();
    graph.launch();
    space().synchronise();
    EXPECT_EQ(stages.calls("test/graph"), 3);
    EXPECT_EQ(stages.calls("test/add_scaled"), 1);
}

TEST_F(CudaGraphTest, MayBeEmpty)
{
    CudaGraph graph(space(), "test/graph");
    graph.record([] {});
    graph.launch();
    expect_sum(0.0);
    EXPECT_EQ(graph.node_count(), 0);
}

} // namespace
} // namespace toile::test
