#pragma once

#include <chrono>
#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>

#include "core/compute/hash.h"

namespace toile {

/// Values made once per key and shared by all their users. A value is freed with its last user; nothing is
/// cached beyond that. Safe to call from several threads.
template <typename T>
class SharedByKey {
public:
    using Shared = std::shared_ptr<const T>;

    /// Value of `key`: the one in use, or a new one. Waits while another thread makes it.
    /// @param make     () -> Shared. Its exceptions reach the caller; one of the waiting threads then makes
    ///                 it anew.
    /// @param waiting  called now and then while another thread makes the value; may throw
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

    /// True if the value of `key` is in use; false while it is being made.
    bool contains(const Hash128& key) const
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

    /// Returns the value in use, or null if the caller has to make it.
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
