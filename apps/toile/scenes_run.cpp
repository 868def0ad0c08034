#include "apps/toile/scenes_run.h"

#include <algorithm>
#include <atomic>
#include <thread>

#include "apps/toile/command_line.h"

namespace toile {

namespace {

/// Scenes that wait to be run, for several threads.
class SceneQueue {
public:
    SceneQueue(const std::vector<SceneJob>& jobs, const RunSettings& settings, bool quiet, Stderr use)
        : jobs_(jobs), settings_(settings), quiet_(quiet), use_(use)
    {
    }

    /// Runs scenes on a GPU until none is left or the user has enough.
    void work(int device)
    {
        RunSettings settings = settings_;
        settings.device = device;
        while (!interrupt_.requested()) {
            const size_t taken = next_++;
            if (taken >= jobs_.size())
                return;
            const RunLog log = log_of(jobs_[taken]);
            const int exit_code =
                run_and_report(log, [&] { return SceneRun(jobs_[taken], settings, log).run(interrupt_); });
            if (exit_code != kExitOk)
                has_failed_ = true;
        }
    }

    /// Names what an interrupt left, once nobody works any more.
    int conclude() const
    {
        for (size_t left = next_; left < jobs_.size(); ++left)
            log_of(jobs_[left]).error("interrupted before it was begun");
        return has_failed_ || next_ < jobs_.size() ? kExitFailure : kExitOk;
    }

private:
    RunLog log_of(const SceneJob& job) const
    {
        return RunLog(quiet_, job.scene.source.stem().string(), use_);
    }

    const std::vector<SceneJob>& jobs_;
    RunSettings settings_;
    bool quiet_;
    Stderr use_;
    InterruptGuard interrupt_;
    std::atomic<size_t> next_ = 0;
    std::atomic<bool> has_failed_ = false;
};

} // namespace

int run_scenes(const std::vector<SceneJob>& jobs, const RunSettings& settings,
               const std::vector<int>& devices, bool quiet)
{
    const size_t used = std::min(devices.size(), jobs.size());
    SceneQueue queue(jobs, settings, quiet, used > 1 ? Stderr::Shared : Stderr::Own);
    {
        std::vector<std::jthread> others; // joined here
        for (size_t i = 1; i < used; ++i)
            others.emplace_back([&queue, device = devices[i]] { queue.work(device); });
        queue.work(devices.front());
    }
    return queue.conclude();
}

} // namespace toile
