#pragma once

namespace toile::app {

/// Scope in which the first Ctrl-C (SIGINT) or SIGTERM only sets a flag, so that a frame can be finished. The
/// second one ends the program as usual.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool requested() const;
};

} // namespace toile::app
