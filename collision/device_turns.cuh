#pragma once

/// What DeviceTurns runs. Included by .cu files, as parallel.cuh.

#include "collision/device_turns.h"
#include "core/backend/cuda/turns.cuh"

namespace toile {

template <typename Push>
void DeviceTurns::run(const Push& push, int sweeps, double margin)
{
    parallel_in_turns(space_, "contact/push", turns_, touches_.terms.size(), sweeps,
                      WatchedPush<Push>{push, touches_.terms, x_, start_.view(), margin, outcome_.view()});
}

} // namespace toile
