#include "core/base/blas_memory.h"

#include <cstddef>
#include <cstdlib>
#include <new>

#include <sys/mman.h>
#include <sys/resource.h>
#include <unistd.h>

namespace toile {

namespace {

constexpr std::size_t kBlasBuffer = std::size_t(130) << 20; ///< [bytes] 128 MiB and what surrounds them
constexpr const char* kThreadCount = "OPENBLAS_NUM_THREADS";

} // namespace

void leave_out_blas_threads(char** arguments)
{
    struct rlimit limit = {};
    if (::getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_cur == RLIM_INFINITY ||
        std::getenv(kThreadCount) != nullptr)
        return;
    ::setenv(kThreadCount, "1", 0);
    ::execv("/proc/self/exe", arguments); // returns only if it fails; the program then goes on as it is
}

void require_blas_buffer()
{
    thread_local bool has_buffer = false;
    if (has_buffer)
        return;
    void* const probe = ::mmap(nullptr, kBlasBuffer, PROT_READ | PROT_WRITE,
                               MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (probe == MAP_FAILED)
        throw std::bad_alloc();
    ::munmap(probe, kBlasBuffer);
    has_buffer = true;
}

} // namespace toile
