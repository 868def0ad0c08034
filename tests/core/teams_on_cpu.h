#pragma once

#include <vector>

namespace toile::test {

/// Threads of a team take turns on the host: a first round adds up what they bring to every sum, and in a
/// second one they hear the totals. Their kernel may write in the second round only (is_own).
template <int Threads>
struct TeamOnCpu {
    static constexpr int kThreads = Threads;

    int thread;
    bool hears;
    std::vector<double>* totals; ///< of the sums, in the order in which they are asked for
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

/// What parallel_for_teams launches, with sums over whole teams.
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
