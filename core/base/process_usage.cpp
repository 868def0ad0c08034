#include "core/base/process_usage.h"

#include <sys/resource.h>

namespace toile {

namespace {

struct rusage usage_so_far()
{
    struct rusage usage = {};
    ::getrusage(RUSAGE_SELF, &usage);
    return usage;
}

} // namespace

long peak_memory()
{
    return usage_so_far().ru_maxrss * 1024; // Linux counts kibibytes
}

double user_seconds()
{
    const struct timeval time = usage_so_far().ru_utime;
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

} // namespace toile
