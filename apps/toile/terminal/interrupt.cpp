#include "apps/toile/terminal/interrupt.h"

#include <atomic>
#include <cstdint>

#include <time.h>

namespace toile::app {

namespace {

/// Signals that follow the first one within this time [ns] are the same request: timeout(1) sends one to the
/// program and one to its group.
constexpr std::int64_t kOneRequest = 500'000'000;

/// Set by the signal handler, read by any thread.
std::atomic<bool> interrupted = false;
std::atomic<std::int64_t> interrupted_at = 0; ///< [ns]
static_assert(std::atomic<bool>::is_always_lock_free && std::atomic<std::int64_t>::is_always_lock_free);

extern "C" void remember_interrupt(int signal)
{
    timespec clock = {};
    ::clock_gettime(CLOCK_MONOTONIC, &clock);
    const std::int64_t now = std::int64_t(clock.tv_sec) * 1'000'000'000 + clock.tv_nsec;
    if (!interrupted) {
        interrupted_at = now;
        interrupted = true;
    } else if (now - interrupted_at > kOneRequest) {
        ::signal(signal, SIG_DFL);
        ::raise(signal);
    }
}

} // namespace

InterruptGuard::InterruptGuard()
{
    interrupted = false;
    struct sigaction action = {};
    action.sa_handler = remember_interrupt;
    for (size_t i = 0; i < kSignals.size(); ++i) {
        ::sigaction(kSignals[i], nullptr, &previous_[i]);
        if (previous_[i].sa_handler != SIG_IGN)
            ::sigaction(kSignals[i], &action, nullptr);
    }
}

InterruptGuard::~InterruptGuard()
{
    for (size_t i = 0; i < kSignals.size(); ++i)
        ::sigaction(kSignals[i], &previous_[i], nullptr);
}

bool InterruptGuard::requested() const { return interrupted; }

} // namespace toile::app
