#include "collision/ccd/collision_free_step.h"

#include "core/base/stages.h"

namespace toile::collision {

CollisionFreeStep::CollisionFreeStep(NearPairs& near, const ExemptPairs& exempt, const Settings& settings,
                                     RigidTrajectories bodies)
    : query_(near, exempt, settings.gap()),
      limiter_(near.edges(), {settings.gap(), settings.max_deflection, settings.first_prescribed},
               std::move(bodies))
{
}

void CollisionFreeStep::begin(View<const Vec3> x, View<const Vec3> expected, View<const double> slack,
                              View<const unsigned char> fixed, View<const NearPair> pairs)
{
    base_.assign(x.begin(), x.end());
    query_.begin(base_, expected, slack, pairs);
    limiter_.begin(base_, fixed);
}

double CollisionFreeStep::limit(View<Vec3> x, View<const unsigned char> supported)
{
    const StageScope stage("collision/collision_free_step");
    const View<const BlockedPair> blocked = query_.query_all(x);
    blocked_.assign(blocked.begin(), blocked.end());
    return blocked.empty() ? 0.0 : limiter_.limit(x, supported, query_, blocked);
}

} // namespace toile::collision
