#pragma once

namespace toile::solvers {

/// Memory that the process takes beyond what it had when the meter was made: of one method among many. Linux
/// can forget its high-water mark; where that is refused, what is resident when asked counts instead, and
/// memory that was freed before goes unseen.
class MemoryMeter {
public:
    MemoryMeter();

    /// Largest so far [MB].
    double peak_mb();

private:
    double start_mb_ = 0.0;
    double peak_mb_ = 0.0;
    bool can_reset_ = false;
};

} // namespace toile::solvers
