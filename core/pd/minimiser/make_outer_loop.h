#pragma once

#include <memory>

#include "core/pd/minimiser/outer_loop.h"
#include "core/pd/minimiser/outer_method.h"

namespace toile {

/// @param history  pairs of L-BFGS, steps of Anderson acceleration; unused by the others. At least 1.
std::unique_ptr<OuterLoop> make_outer_loop(OuterMethod method, int history);

} // namespace toile
