#include "research/benchmarks/memory_meter.h"

#include <algorithm>
#include <fstream>
#include <string>

#include <malloc.h>

namespace toile::research {

namespace {

/// Value of a line of /proc/self/status in kibibytes, converted to [MB]; 0 without one.
double status_mb(const std::string& key)
{
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (word == key) {
            double kibibytes = 0.0;
            status >> kibibytes;
            return kibibytes * 1024.0 / 1e6;
        }
    return 0.0;
}

/// Resets the high-water mark to the resident memory.
bool reset_high_water()
{
    std::ofstream reset("/proc/self/clear_refs");
    reset << "5" << std::flush;
    return reset.good();
}

} // namespace

MemoryMeter::MemoryMeter()
{
    ::malloc_trim(0); // otherwise a method reuses memory that the previous one returned
    can_reset_ = reset_high_water();
    start_mb_ = status_mb("VmRSS:");
}

double MemoryMeter::peak_mb()
{
    const double now = status_mb(can_reset_ ? "VmHWM:" : "VmRSS:");
    peak_mb_ = std::max(peak_mb_, now - start_mb_);
    return peak_mb_;
}

} // namespace toile::research
