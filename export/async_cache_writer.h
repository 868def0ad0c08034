#pragma once

#include <condition_variable>
#include <deque>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

#include "export/cache_writer.h"

namespace toile::exports {

/// Writes to another cache on a separate thread, in the order of the calls, so that the simulation does not
/// wait for the disk. The caller may change its arrays as soon as write() returns.
class AsyncCacheWriter final : public CacheWriter {
public:
    /// @param queue_limit  maximum frames in memory (1 or more); write() waits while all are in use
    explicit AsyncCacheWriter(std::unique_ptr<CacheWriter> target, int queue_limit = 4);

    /// close(). Errors are lost here; complete() reports them.
    ~AsyncCacheWriter() override;

    /// Queues a copy. @throws the exception of an earlier failed write; nothing is written after that.
    void write(int frame, const SampleView& sample) override;

    /// Returns a frame when it is due for writing, or throws on failure. It is called once, on the writer's
    /// thread, and destroyed when the frame is written.
    using LateSample = std::function<CacheSample()>;

    /// Queues a frame that may not have arrived yet, without a copy. @throws as write()
    void write_later(int frame, LateSample sample);

    /// Waits for the queue and completes the target. @throws its exception, or that of an earlier write.
    std::filesystem::path complete() override;
    void publish() override { target_->publish(); }

    /// Waits for the queue and keeps the target, unless it failed. @throws its exception
    void keep() override;
    int readable_samples() const override;

    /// keep() without exceptions; nothing can be written afterwards. @return readable_samples()
    int close();

    std::filesystem::path partial() const override { return target_->partial(); }
    std::string note() const override { return target_->note(); }

private:
    struct Frame {
        int index = 0;
        LateSample late; ///< empty: `sample` is valid
        CacheSample sample;
    };

    Frame take_free(int index);
    void enqueue(Frame frame);
    void deliver_until_closed();
    std::exception_ptr deliver(const Frame& frame);
    void deliver_rest();
    void rethrow_error() const;

    std::unique_ptr<CacheWriter> target_;
    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Frame> queue_;
    std::vector<Frame> free_; ///< buffers of delivered frames, reused
    std::exception_ptr error_;
    int readable_ = 0;           ///< readable_samples() of the target between its frames
    bool target_failed_ = false; ///< of the thread, until it ends
    bool closed_ = false;
    std::thread thread_;
};

} // namespace toile::exports
