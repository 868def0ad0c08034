#pragma once

#include <vector>

namespace toile::test {

/// Threads of a team, run one after the other on the host. A first pass accumulates their contributions to
/// every sum, a second pass returns the totals. The kernel may write in the second pass only (is_own).
template <int Threads>
struct TeamOnCpu {
    static constexpr int kThreads = Threads;

    int thread;
    bool hears;
    std::vector<double>* totals; ///< of the sums, in the order of the calls
    mutable int asked = 0;

    template <typename Number>
    Number sum(int, Number value) const
    {
        if (asked == int(totals->size()))
            totals->push_back(0.0);
        double& total = (*totals)[asked++];
        if (!hears)
            total += double(value);
        return Number(total);
    }
};

/// Runs a kernel of parallel_for_teams with sums over whole teams.
template <int Threads, typename Kernel>
void run_teams(int count, const Kernel& kernel)
{
    std::vector<double> totals;
    for (int i = 0; i < count; ++i) {
        totals.clear();
        for (int thread = 0; thread < Threads; ++thread)
            kernel(i, TeamOnCpu<Threads>{thread, false, &totals}, false);
        for (int thread = 0; thread < Threads; ++thread)
            kernel(i, TeamOnCpu<Threads>{thread, true, &totals}, true);
    }
}

} // namespace toile::test
