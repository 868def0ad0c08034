#include "apps/toile/terminal/interrupt.h"

#include <atomic>

namespace toile::app {

namespace {

/// Set by the signal handler, read by any thread.
std::atomic<bool> interrupted = false;
static_assert(std::atomic<bool>::is_always_lock_free);

extern "C" void remember_interrupt(int) { interrupted = true; }

} // namespace

InterruptGuard::InterruptGuard()
{
    interrupted = false;
    struct sigaction action = {};
    action.sa_handler = remember_interrupt;
    action.sa_flags = int(SA_RESETHAND); // the second signal has the default action
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
