#pragma once

/// TOILE_UNROLL(count) before a loop: a GPU runs so many iterations at once, whose loads then don't wait for
/// each other. Other compilers decide for themselves.
#ifdef __CUDACC__
#define TOILE_PRAGMA(words) _Pragma(#words)
#define TOILE_UNROLL(count) TOILE_PRAGMA(unroll count)
#else
#define TOILE_UNROLL(count)
#endif
