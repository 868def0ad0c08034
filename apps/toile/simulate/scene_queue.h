#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace toile::app {

/// Queue of scenes for several GPUs. Each GPU has a thread that takes the next scene when it has finished
/// one. Scenes and GPUs are known only to Calls, which are called from several threads at once.
///
/// A GPU that no longer responds takes no more scenes; the other GPUs take those left. The scene on which it
/// failed is not retried, because it may have caused the failure and would then take down the next GPU too. A
/// call that never returns is not detected.
class SceneQueue {
public:
    struct Calls {
        /// Runs a scene on a GPU and reports its failure. @return true on success. Does not throw.
        std::function<bool(std::size_t scene, int device)> run;
        /// Whether a GPU still responds; called after a scene has failed on it.
        std::function<bool(int device)> is_responding;
        std::function<bool()> is_interrupted;
        /// Reports that a scene is not run; called after all threads have ended.
        std::function<void(std::size_t scene, const std::string& reason)> leave_out;
    };

    SceneQueue(std::size_t scene_count, Calls calls);

    /// Runs the scenes, or as many as possible.
    /// @param devices  numbers of the GPUs, at least one; GPUs beyond the number of scenes are not used
    /// @return true if all of them succeeded
    bool run(const std::vector<int>& devices);

private:
    void work(int device);
    void leave_out_the_rest(const std::vector<int>& devices);

    std::size_t scene_count_;
    Calls calls_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> has_failed_ = false;
};

} // namespace toile::app
