#pragma once

#include <vector>

#include "apps/toile/simulate/scene_run.h"

namespace toile::app {

/// Runs independent scenes in parallel on several GPUs (SceneQueue), or one after the other on the CPU. A
/// failed scene does not stop the others, nor does a failed GPU while another one responds. An interrupt ends
/// the running scenes as it ends a single one; the others are not started.
/// @param devices  numbers of the GPUs; for Backend::Cpu one arbitrary number
/// @return kExitFailure if one of them failed or was not run, which is reported on stderr with its name
int run_scenes(const std::vector<SceneJob>& jobs, const RunSettings& settings,
               const std::vector<int>& devices, bool quiet);

} // namespace toile::app
