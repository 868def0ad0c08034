#pragma once

#include <vector>

#include "apps/toile/scene_run.h"

namespace toile {

/// Runs scenes that know nothing of each other, on several GPUs side by side (SceneQueue). On the CPU they
/// run one after the other. A scene that fails does not keep the others from running, nor does a GPU that no
/// longer answers, as long as another one does; an interrupt ends those that run as it ends a single one, and
/// the rest is not begun.
/// @param devices  numbers of the GPUs; for Backend::Cpu one number, whatever it is
/// @return kExitFailure where one of them failed or was not run, which is said on stderr with its name
int run_scenes(const std::vector<SceneJob>& jobs, const RunSettings& settings,
               const std::vector<int>& devices, bool quiet);

} // namespace toile
