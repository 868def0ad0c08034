#pragma once

#include <atomic>
#include <cstddef>
#include <functional>
#include <string>
#include <vector>

namespace toile {

/// Scenes that wait to be run and GPUs that take them, each the next one when it is done with one, in a
/// thread of its own. It knows neither: what both do is in Calls, which come from several threads at once.
///
/// A GPU that no longer answers takes no more scenes; those left go to the others. The scene that it was lost
/// with has failed and is not tried elsewhere: where it is what took the GPU away, it would take the next one
/// too. A call that never returns is not noticed.
class SceneQueue {
public:
    struct Calls {
        /// Runs a scene on a GPU; says itself why it failed. @return true where it went well. Does not throw.
        std::function<bool(std::size_t scene, int device)> run;
        /// Whether a GPU still takes work; asked where a scene has failed on it.
        std::function<bool(int device)> answers;
        std::function<bool()> is_interrupted;
        /// Says of a scene that it is not run, once nobody works any more.
        std::function<void(std::size_t scene, const std::string& reason)> leave_out;
    };

    SceneQueue(std::size_t scene_count, Calls calls);

    /// Runs the scenes, or as many as can be.
    /// @param devices  numbers of the GPUs, at least one; those beyond the number of scenes are left alone
    /// @return true where all of them went well
    bool run(const std::vector<int>& devices);

private:
    void work(int device);
    void leave_out_the_rest(const std::vector<int>& devices);

    std::size_t scene_count_;
    Calls calls_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> has_failed_ = false;
};

} // namespace toile
