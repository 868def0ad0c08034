#include "apps/toile/simulate/scenes_run.h"

#include <utility>

#include "apps/toile/simulate/scene_queue.h"
#include "apps/toile/terminal/command_line.h"
#include "core/compute/cuda/runtime/answers.h"
#include "core/compute/cuda/runtime/device.h"

namespace toile::app {

int run_scenes(const std::vector<SceneJob>& jobs, const RunSettings& settings,
               const std::vector<int>& devices, bool quiet)
{
    const Stderr use = devices.size() > 1 && jobs.size() > 1 ? Stderr::Shared : Stderr::Exclusive;
    const auto log_of = [&](std::size_t scene) {
        return RunLog(quiet, jobs[scene].scene.source.stem().string(), use);
    };
    const bool has_gpus = settings.backend != scenes::Backend::Cpu && !cuda_devices().empty();
    const InterruptGuard interrupt;

    SceneQueue::Calls calls;
    calls.run = [&](std::size_t scene, int device) {
        RunSettings device_settings = settings;
        device_settings.device = device;
        const RunLog log = log_of(scene);
        return run_and_report(log, [&] {
                   return SceneRun(jobs[scene], device_settings, log, &interrupt).run(interrupt);
               }) == kExitOk;
    };
    calls.is_responding = [&](int device) {
        if (!has_gpus || is_responding(device))
            return true;
        RunLog(quiet, "", use)
            .note("GPU " + std::to_string(device) + " no longer answers and takes no more scenes");
        return false;
    };
    calls.is_interrupted = [&] { return interrupt.requested(); };
    calls.leave_out = [&](std::size_t scene, const std::string& reason) { log_of(scene).error(reason); };
    return SceneQueue(jobs.size(), std::move(calls)).run(devices) ? kExitOk : kExitFailure;
}

} // namespace toile::app
