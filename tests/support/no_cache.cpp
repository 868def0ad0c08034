#include <cstdlib>

namespace {

/// Part of every test program: no test or program that it starts uses the user's cache. Tests of the cache
/// name folders of their own.
[[maybe_unused]] const int no_cache = ::setenv("TOILE_CACHE_DIR", "", 1);

} // namespace
