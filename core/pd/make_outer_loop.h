#pragma once

#include <memory>

#include "core/pd/outer_loop.h"
#include "core/pd/outer_method.h"

namespace toile {

/// @param history  pairs of L-BFGS, moves of Anderson acceleration; the others have none. At least 1.
std::unique_ptr<OuterLoop> make_outer_loop(OuterMethod method, int history);

} // namespace toile
