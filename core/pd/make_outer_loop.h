#pragma once

#include <memory>

#include "core/pd/outer_loop.h"

namespace toile {

/// The methods of the outer loop, compared in docs/core/pd.md.
enum class OuterMethod { Lbfgs, LocalGlobal, Anderson };

/// @param history  pairs of L-BFGS, moves of Anderson acceleration; the others have no memory. At least 1.
std::unique_ptr<OuterLoop> make_outer_loop(OuterMethod method, int history);

} // namespace toile
