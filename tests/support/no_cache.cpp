#include <cstdlib>

namespace {

/// Part of every test program: no test reads or fills the cache of who runs it, nor do the programs that it
/// starts. Tests of the cache name folders of their own.
[[maybe_unused]] const int no_cache = ::setenv("TOILE_CACHE_DIR", "", 1);

} // namespace
