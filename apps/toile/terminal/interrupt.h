#pragma once

#include <array>

#include <signal.h>

namespace toile::app {

/// Scope in which the first Ctrl-C (SIGINT), SIGTERM or SIGHUP only sets a flag, so that a run can
/// end in order. One that comes half a second later, or more, ends the program as usual. Signals that the
/// caller ignores (nohup) stay ignored.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool requested() const;

private:
    static constexpr std::array<int, 3> kSignals{SIGINT, SIGTERM, SIGHUP};
    std::array<struct sigaction, kSignals.size()> previous_{};
};

} // namespace toile::app
