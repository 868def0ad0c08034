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

namespace toile {

/// Writes to another cache on a thread of its own, in the order of the calls, so that the simulation does
/// not wait for the disk. The caller may change its positions as soon as write() returns.
class AsyncCacheWriter final : public CacheWriter {
public:
    /// @param queue_limit  frames held in memory at most (1 or more); write() waits while all are taken
    explicit AsyncCacheWriter(std::unique_ptr<CacheWriter> target, int queue_limit = 4);

    /// Delivers what was queued to the partial; an error then is lost, call finish() to see it.
    ~AsyncCacheWriter() override;

    /// Queues a copy. @throws what writing an earlier frame threw; nothing is written after that.
    void write(int frame, View<const Vec3> positions) override;

    /// Gives a frame's positions [vertices] [m] when they are to be written, and throws where it can't. It
    /// owns what it reads, is called once, on the writer's thread, and is gone when the frame is written.
    using LatePositions = std::function<View<const Vec3>()>;

    /// Queues positions that may still be on their way, without a copy. @throws as write()
    void write_later(int frame, LatePositions positions);

    /// Waits for the queue and finishes the target. @throws what it or an earlier write threw.
    void finish() override;

    /// Waits for the queue; nothing can be written any more. @return frames that the target has taken
    int close();

    std::filesystem::path partial() const override { return target_->partial(); }

private:
    struct Frame {
        int index = 0;
        LatePositions late;          ///< empty: they are here
        std::vector<Vec3> positions; ///< [vertices] [m]
    };

    Frame take_free(int index);
    void enqueue(Frame frame);
    void deliver_until_closed();
    std::exception_ptr deliver(const Frame& frame);
    void rethrow_error() const;

    std::unique_ptr<CacheWriter> target_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::deque<Frame> queue_;
    std::vector<Frame> free_; ///< buffers of delivered frames, reused
    std::exception_ptr error_;
    int delivered_ = 0;
    bool closed_ = false;
    std::thread thread_;
};

} // namespace toile
