#include "core/pd/minimiser/local_global.h"

#include "core/linear/field.h"

namespace toile {

void LocalGlobal::find_direction(Objective& objective, const Here& here, View<Vec3> direction)
{
    objective.precondition(here.gradient, direction);
    parallel_for(
        kCpu, "local_global/negate", direction.size(), [&](int i) { direction[i] = -direction[i]; },
        kFieldGrain);
}

} // namespace toile
