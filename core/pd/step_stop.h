#pragma once

namespace toile {

/// What a step may end by. In either case no vertex moves further than the tolerance in an iteration, and the
/// step has answered what drives it.
enum class StepStop {
    Error, ///< the error that StepError estimates is within the tolerance too
    Move   ///< nothing more, as papers state for their iterations: how far the minimiser is remains open
};

} // namespace toile
