#include "collision/cloth/safe_step.h"

#include "core/backend/stages.h"

namespace toile {

SafeStep::SafeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings, RigidWays bodies)
    : watch_(near, exempt, settings.gap()),
      bring_back_(near.edges(), {settings.gap(), settings.most_deflection}, std::move(bodies))
{
}

void SafeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                     View<const unsigned char> fixed, View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    watch_.begin(base_, expected, slack, pairs);
    bring_back_.begin(base_, fixed);
}

double SafeStep::limit(View<Vec3> x, View<const unsigned char> leans)
{
    const StageScope stage("collision/safe_step");
    const View<const BlockedPair> in_the_way = watch_.look_at_all(x);
    return in_the_way.empty() ? 0.0 : bring_back_.limit(x, leans, watch_, in_the_way);
}

} // namespace toile
