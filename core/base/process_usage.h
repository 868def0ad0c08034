#pragma once

namespace toile {

/// Largest resident memory of this process so far [bytes].
long peak_memory();

/// Processor time of this process so far outside the kernel, all threads together [s].
double user_seconds();

} // namespace toile
