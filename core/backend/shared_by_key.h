#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "core/backend/hash.h"

namespace toile {

/// Values that are made once per key and shared by all who ask for them while one of them lives. Nothing is
/// kept for its own sake: a value goes with its last user. Safe to call from several threads.
template <typename T>
class SharedByKey {
public:
    using Shared = std::shared_ptr<const T>;

    /// The value of `key`: the one in use, or a new one. Who asks while another thread makes it waits.
    /// @param make     () -> Shared. What it throws reaches the caller; of those who wait, one makes it anew.
    /// @param waiting  called now and then while another thread is at it; may throw
    template <typename Make, typename Waiting>
    Shared get(const Hash128& key, const Make& make, const Waiting& waiting)
    {
        if (Shared value = find_or_claim(key, waiting))
            return value;
        Shared value;
        try {
            value = make();
        } catch (...) {
            finish(key, nullptr);
            throw;
        }
        finish(key, value);
        return value;
    }

    /// True while somebody uses the value of `key`; one that is being made is not there yet.
    bool holds(const Hash128& key) const
    {
        const std::lock_guard lock(mutex_);
        const auto entry = entries_.find(key);
        return entry != entries_.end() && !entry->second.value.expired();
    }

private:
    struct Entry {
        std::weak_ptr<const T> value;
        bool is_being_made = false;
    };

    /// Null where the caller is the one to make it.
    template <typename Waiting>
    Shared find_or_claim(const Hash128& key, const Waiting& waiting)
    {
        constexpr std::chrono::milliseconds kPoll(20);
        std::unique_lock lock(mutex_);
        for (;;) {
            Entry& entry = entries_[key];
            if (Shared value = entry.value.lock())
                return value;
            if (!entry.is_being_made) {
                entry.is_being_made = true;
                return nullptr;
            }
            changed_.wait_for(lock, kPoll);
            lock.unlock();
            waiting();
            lock.lock();
        }
    }

    void finish(const Hash128& key, const Shared& value)
    {
        {
            const std::lock_guard lock(mutex_);
            entries_[key] = {value, false};
            std::erase_if(entries_, [](const auto& item) {
                return !item.second.is_being_made && item.second.value.expired();
            });
        }
        changed_.notify_all();
    }

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::map<Hash128, Entry> entries_;
};

} // namespace toile
