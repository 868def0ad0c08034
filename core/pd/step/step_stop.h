#pragma once

namespace toile {

/// Stopping criterion of a step. In either case no vertex moves further than the tolerance in an iteration,
/// and the step has responded to its driving force.
enum class StepStop {
    Error, ///< the error that StepError estimates is within the tolerance too
    Move   ///< no further condition, as in papers: the distance from the minimiser remains unknown
};

} // namespace toile
