#pragma once

namespace toile {

/// OpenBLAS maps a buffer of 128 MiB for each of its own threads when it is loaded, and for each thread that
/// calls it; where it can't, it tries for ever. These two functions turn that into an error.

/// Starts the program anew without OpenBLAS's own threads, which Toile does not use, if its address space is
/// limited (ulimit -v). To be called first in main().
void leave_out_blas_threads(char** arguments);

/// To be called before BLAS, by every thread that calls it.
/// @throws std::bad_alloc if there is no room for the buffer
void require_blas_buffer();

} // namespace toile
