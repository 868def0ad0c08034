#include "apps/toile/terminal/interrupt.h"

#include <atomic>
#include <csignal>

#include <signal.h>

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
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
}

InterruptGuard::~InterruptGuard()
{
    std::signal(SIGINT, SIG_DFL);
    std::signal(SIGTERM, SIG_DFL);
}

bool InterruptGuard::requested() const { return interrupted; }

} // namespace toile::app
