#include "core/pd/device/device_descent.h"

#include "core/backend/cuda/record_sum.cuh"

namespace toile {

namespace {

/// Turns of the graph. The host asks between graphs whether the descent is over, which costs about as much as
/// half a turn; turns after its end cost as much as others.
constexpr int kTurnsAtOnce = 4;

/// The fewest that a descent takes: it begins, and sees that its first direction is nothing.
constexpr int kFewestTurns = 2;

} // namespace

DeviceDescent::DeviceDescent(const CudaSpace& space, int vertex_count, int share_count)
    : space_(space), x_(space, "descent/x", vertex_count), gradient_(space, "descent/gradient", vertex_count),
      z_(space, "descent/z", vertex_count), trial_x_(space, "descent/trial_x", vertex_count),
      trial_gradient_(space, "descent/trial_gradient", vertex_count),
      trial_z_(space, "descent/trial_z", vertex_count),
      energy_(space, "descent/energy", vertex_count + share_count),
      direction_(space, "descent/direction", vertex_count), s_(space, "descent/s", kHistory * vertex_count),
      y_(space, "descent/y", kHistory * vertex_count), w_(space, "descent/w", kHistory * vertex_count),
      descent_(space, "descent/state"), sums_(space), on_host_(space, "descent/on_host", 1),
      turns_(space, "descent/turns"), few_turns_(space, "descent/turns"), expected_turns_(kTurnsAtOnce)
{
    descent_.upload(std::vector<Descent>(1));
    for (DeviceArray<PaddedVec3>* pairs : {&s_, &y_, &w_})
        pairs->fill_zero();
}

DescentFields DeviceDescent::fields(const Problem& problem)
{
    return {{x_.view(), gradient_.view(), z_.view()},
            {trial_x_.view(), trial_gradient_.view(), trial_z_.view()},
            energy_.view(),
            direction_.view(),
            s_.view(),
            y_.view(),
            w_.view(),
            problem.masses,
            problem.fixed,
            problem.drive,
            {problem.masses, problem.prediction, 1.0 / (problem.dt * problem.dt), trial_x_.view(),
             trial_gradient_.view()},
            descent_.view()};
}

void DeviceDescent::enqueue_turn(const Problem& problem)
{
    const int n = x_.size();
    problem.add_gradient({trial_x_.view(), trial_gradient_.view(), energy_.view().subview(0, n),
                          energy_.view().subview(n, energy_.size() - n)});
    problem.precondition(trial_gradient_.view(), trial_z_.view());
    const DescentFields all = fields(problem);
    parallel_sum_record_then<TrialSums>(space_, "descent/decide", x_.size(), MeasureTrial{all},
                                        DecideOnTrial{descent_.view()}, sums_);
    parallel_for(space_, "descent/take", x_.size(), TakeTrial{all});
}

void DeviceDescent::record(const Problem& problem)
{
    const auto enqueue = [&](int turns) {
        for (int turn = 0; turn < turns; ++turn)
            enqueue_turn(problem);
    };
    turns_.record([&] { enqueue(kTurnsAtOnce); });
    few_turns_.record([&] { enqueue(kFewestTurns); });
}

const Descent& DeviceDescent::state()
{
    descent_.download(on_host_.view());
    space_.synchronise();
    return on_host_[0];
}

Descent DeviceDescent::run_briefly()
{
    few_turns_.launch();
    return state();
}

Descent DeviceDescent::run()
{
    const StageScope stage("descent/run");
    TOILE_ASSERT(turns_.node_count() > 0);
    int turns = 0;
    bool is_over = expected_turns_ <= kFewestTurns && run_briefly().is_over;
    while (!is_over) {
        do {
            turns_.launch();
            turns += kTurnsAtOnce;
        } while (turns < expected_turns_);
        is_over = state().is_over;
    }
    const Descent& found = on_host_[0];
    expected_turns_ = found.turns;
    return found;
}

} // namespace toile
