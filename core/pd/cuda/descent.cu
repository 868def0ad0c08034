#include "core/pd/cuda/descent.h"

#include "core/compute/cuda/record_sum.cuh"

namespace toile {

namespace {

/// Evaluations per graph. Between graphs the host checks whether the descent is over, which costs about half
/// an evaluation; evaluations after its end cost as much as others.
constexpr int kEvaluationsPerGraph = 4;

/// Minimum number of evaluations: a start, and a first direction that proves negligible.
constexpr int kMinEvaluations = 2;

} // namespace

DeviceDescent::DeviceDescent(const CudaSpace& space, int vertex_count, int partial_count)
    : space_(space), x_(space, "descent/x", vertex_count), gradient_(space, "descent/gradient", vertex_count),
      z_(space, "descent/z", vertex_count), trial_x_(space, "descent/trial_x", vertex_count),
      trial_gradient_(space, "descent/trial_gradient", vertex_count),
      trial_z_(space, "descent/trial_z", vertex_count),
      energy_(space, "descent/energy", vertex_count + partial_count),
      direction_(space, "descent/direction", vertex_count), s_(space, "descent/s", kHistory * vertex_count),
      y_(space, "descent/y", kHistory * vertex_count), w_(space, "descent/w", kHistory * vertex_count),
      descent_(space, "descent/state"), sums_(space), on_host_(space, "descent/on_host", 1),
      graph_(space, "descent/graph"), short_graph_(space, "descent/turns"),
      expected_evaluations_(kEvaluationsPerGraph)
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
            {problem.inertia, problem.prediction, trial_x_.view(), trial_gradient_.view()},
            descent_.view()};
}

void DeviceDescent::enqueue_evaluation(const Problem& problem)
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
    const auto enqueue = [&](int evaluations) {
        for (int k = 0; k < evaluations; ++k)
            enqueue_evaluation(problem);
    };
    graph_.record([&] { enqueue(kEvaluationsPerGraph); });
    short_graph_.record([&] { enqueue(kMinEvaluations); });
}

const Descent& DeviceDescent::state()
{
    descent_.download(on_host_.view());
    space_.synchronise();
    return on_host_[0];
}

Descent DeviceDescent::run_briefly()
{
    short_graph_.launch();
    return state();
}

Descent DeviceDescent::run()
{
    const StageScope stage("descent/run");
    TOILE_ASSERT(graph_.node_count() > 0);
    int evaluations = 0;
    bool is_over = expected_evaluations_ <= kMinEvaluations && run_briefly().is_over;
    while (!is_over) {
        do {
            graph_.launch();
            evaluations += kEvaluationsPerGraph;
        } while (evaluations < expected_evaluations_);
        is_over = state().is_over;
    }
    const Descent& found = on_host_[0];
    expected_evaluations_ = found.evaluations;
    return found;
}

} // namespace toile
