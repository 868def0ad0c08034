#pragma once

namespace toile::research {

/// Peak memory of the process above that at construction: of one method among many. Linux can reset its
/// high-water mark. If that is refused, the resident memory at the time of the call counts instead, and
/// memory freed before is not seen.
class MemoryMeter {
public:
    MemoryMeter();

    /// Peak so far [MB].
    double peak_mb();

private:
    double start_mb_ = 0.0;
    double peak_mb_ = 0.0;
    bool can_reset_ = false;
};

} // namespace toile::research
