#include "core/base/process_usage.h"

#include <cstdlib>
#include <fstream>
#include <string>

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

/// ru_maxrss would be that of the program which started this one, if it was larger.
long peak_memory()
{
    static constexpr const char* kPeak = "VmHWM:";
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);)
        if (line.starts_with(kPeak))
            return 1024 *
                   std::strtol(line.c_str() + std::string(kPeak).size(), nullptr, 10); // from kibibytes
    return usage_so_far().ru_maxrss * 1024;
}

double user_seconds()
{
    const struct timeval time = usage_so_far().ru_utime;
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

} // namespace toile
