#include "apps/toile/simulate/scene_queue.h"

#include <algorithm>
#include <thread>
#include <utility>

namespace toile::app {

SceneQueue::SceneQueue(std::size_t scene_count, Calls calls)
    : scene_count_(scene_count), calls_(std::move(calls))
{
}

bool SceneQueue::run(const std::vector<int>& devices)
{
    const std::size_t used = std::min(devices.size(), scene_count_);
    {
        std::vector<std::jthread> others; // joined here
        for (std::size_t i = 1; i < used; ++i)
            others.emplace_back([this, device = devices[i]] { work(device); });
        work(devices.front());
    }
    leave_out_the_rest(devices);
    return !has_failed_;
}

/// Runs scenes on a GPU until none is left, the user interrupts, or the GPU fails.
void SceneQueue::work(int device)
{
    while (!calls_.is_interrupted()) {
        const std::size_t taken = next_++;
        if (taken >= scene_count_)
            return;
        if (calls_.run(taken, device))
            continue;
        has_failed_ = true;
        if (!calls_.is_responding(device))
            return;
    }
}

void SceneQueue::leave_out_the_rest(const std::vector<int>& devices)
{
    if (next_ >= scene_count_)
        return;
    has_failed_ = true;
    std::string list;
    for (const int device : devices)
        list += (list.empty() ? "" : ", ") + std::to_string(device);
    const std::string lost =
        devices.size() > 1 ? "GPUs " + list + " no longer answer" : "GPU " + list + " no longer answers";
    const std::string reason =
        calls_.is_interrupted() ? "interrupted before it was begun" : "was not run: " + lost;
    for (std::size_t left = next_; left < scene_count_; ++left)
        calls_.leave_out(left, reason);
}

} // namespace toile::app
