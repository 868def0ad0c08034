#include "export/async_cache_writer.h"

#include <algorithm>
#include <utility>

namespace toile::exports {

AsyncCacheWriter::AsyncCacheWriter(std::unique_ptr<CacheWriter> target, int queue_limit)
    : target_(std::move(target)), free_(size_t(std::max(queue_limit, 1))),
      readable_(target_->readable_samples()), thread_([this] { deliver_until_closed(); })
{
}

AsyncCacheWriter::~AsyncCacheWriter() { close(); }

void AsyncCacheWriter::write(int frame, const SampleView& sample)
{
    Frame copy = take_free(frame);
    copy.sample.positions.assign(sample.positions.begin(), sample.positions.end());
    copy.sample.attributes.assign(sample.attributes.begin(), sample.attributes.end());
    enqueue(std::move(copy));
}

void AsyncCacheWriter::write_later(int frame, LateSample sample)
{
    Frame late = take_free(frame);
    late.late = std::move(sample);
    enqueue(std::move(late));
}

AsyncCacheWriter::Frame AsyncCacheWriter::take_free(int index)
{
    TOILE_ASSERT(thread_.joinable());
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [this] { return !free_.empty() || error_; });
    rethrow_error();
    Frame frame = std::move(free_.back());
    free_.pop_back();
    frame.index = index;
    return frame;
}

void AsyncCacheWriter::enqueue(Frame frame)
{
    const std::lock_guard lock(mutex_);
    queue_.push_back(std::move(frame));
    changed_.notify_all();
}

std::filesystem::path AsyncCacheWriter::complete()
{
    deliver_rest();
    rethrow_error();
    return target_->complete();
}

void AsyncCacheWriter::deliver_until_closed()
{
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [this] { return !queue_.empty() || closed_; });
        if (queue_.empty())
            return;
        Frame frame = std::move(queue_.front());
        queue_.pop_front();

        // Drop the remaining frames after an error: a cache with a gap would be worse than a short one.
        const bool is_dropped = error_ != nullptr;
        lock.unlock();
        const std::exception_ptr error = is_dropped ? nullptr : deliver(frame);
        frame.late = nullptr;
        lock.lock();
        if (error)
            error_ = error;
        readable_ = target_->readable_samples();
        free_.push_back(std::move(frame));
        changed_.notify_all();
    }
}

/// @return the error, or null
std::exception_ptr AsyncCacheWriter::deliver(const Frame& frame)
{
    try {
        const CacheSample late = frame.late ? frame.late() : CacheSample{};
        target_failed_ = true;
        target_->write(frame.index, frame.late ? late : frame.sample);
        target_failed_ = false;
    } catch (...) {
        return std::current_exception();
    }
    return nullptr;
}

int AsyncCacheWriter::close()
{
    try {
        keep();
    } catch (const std::exception&) {
        // readable_samples() says what there is without it
    }
    return readable_samples();
}

void AsyncCacheWriter::keep()
{
    deliver_rest();
    if (target_failed_)
        return;
    target_->keep();
    readable_ = target_->readable_samples();
}

int AsyncCacheWriter::readable_samples() const
{
    const std::lock_guard lock(mutex_);
    return readable_;
}

/// Waits for the queue, and ends the thread.
void AsyncCacheWriter::deliver_rest()
{
    {
        const std::lock_guard lock(mutex_);
        closed_ = true;
        changed_.notify_all();
    }
    if (thread_.joinable())
        thread_.join();
}

void AsyncCacheWriter::rethrow_error() const
{
    if (error_)
        std::rethrow_exception(error_);
}

} // namespace toile::exports
