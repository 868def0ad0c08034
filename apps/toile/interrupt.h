#pragma once

namespace toile {

/// While it lives, the first Ctrl-C (SIGINT) or SIGTERM is remembered instead of ending the program, so that
/// a frame can be finished; the second one ends it as usual.
class InterruptGuard {
public:
    InterruptGuard();
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool requested() const;
};

} // namespace toile
