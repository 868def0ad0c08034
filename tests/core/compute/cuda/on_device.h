#pragma once

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include "core/compute/cuda/runtime/device.h"

namespace toile::test {

/// Fixture of tests that need a GPU: it has device 0, or is skipped with the reason.
class OnDevice : public ::testing::Test {
protected:
    void SetUp() override
    {
        if (const std::string reason = why_no_cuda_device(); !reason.empty())
            GTEST_SKIP() << "no CUDA device: " << reason;
        space_ = std::make_unique<CudaSpace>(0);
    }

    const CudaSpace& space() const { return *space_; }

    /// Number of calls of the device's allocator while work() runs.
    template <typename Work>
    long allocations_of(const Work& work) const
    {
        const long before = space().memory().allocations;
        work();
        return space().memory().allocations - before;
    }

private:
    std::unique_ptr<CudaSpace> space_;
};

/// Message of the Error that `action` throws; empty if it throws none.
template <typename Error, typename Action>
std::string message_of(const Action& action)
{
    try {
        action();
    } catch (const Error& error) {
        return error.what();
    }
    return {};
}

/// True if `text` contains the parts in that order, with anything between them.
template <typename... Parts>
bool contains_in_order(const std::string& text, const Parts&... parts)
{
    size_t at = 0;
    const auto find = [&](const std::string& part) {
        const size_t found = text.find(part, at);
        at = found + part.size();
        return found != std::string::npos;
    };
    return (find(parts) && ...);
}

} // namespace toile::test
