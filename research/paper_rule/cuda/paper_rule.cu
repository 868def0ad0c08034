#include "research/paper_rule/cuda/paper_rule.h"

#include "core/compute/cuda/teams.cuh"

namespace toile::research {

DevicePaperRule::DevicePaperRule(const CudaSpace& space, View<const Vec2> uv, View<const Triangle> triangles,
                                 const Settings& settings)
    : DeviceSolver(space), on_cpu_(uv, triangles, settings), rule_(space), H_(space),
      left_(space, "paper_rule/left")
{
}

void DevicePaperRule::Rows::upload(const WeightedRows& rows)
{
    first.upload(rows.first);
    entries.upload(rows.entries);
}

void DevicePaperRule::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    on_cpu_.update(H, fixed);
    rule_.upload(on_cpu_.rule());
    H_.upload(on_cpu_.matrix());
    left_.resize(fixed.size());
}

void DevicePaperRule::solve_on_device(View<const Vec3> b, View<Vec3> x) const
{
    constexpr int kThreads = WeightedRows::kThreads;
    parallel_for_teams<kThreads>(space(), "paper_rule/solve", x.size(), ApplyRule{rule_.view(), b, x});
    for (int done = 1; done < on_cpu_.settings().applications; ++done) {
        parallel_for_teams<kThreads>(space(), "paper_rule/residual", x.size(),
                                     RuleResidual{H_.view(), b, x, left_.view()});
        parallel_for_teams<kThreads>(space(), "paper_rule/correct", x.size(),
                                     CorrectByRule{rule_.view(), left_.view(), x});
    }
}

} // namespace toile::research
