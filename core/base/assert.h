#pragma once

/// TOILE_ASSERT(condition) reports a bug of ours. Checked in Debug and RelWithDebInfo (CMake defines
/// TOILE_CHECKED there), free in Release. Wrong input from outside is InvalidInput instead (error.h).

#ifdef TOILE_CHECKED
#include <cassert>
#define TOILE_ASSERT(condition) assert(condition)
#else
#define TOILE_ASSERT(condition) static_cast<void>(0)
#endif
