#pragma once

#include "core/compute/types.h"

namespace toile::research {

/// Returns 1 if the position of vertex i is not finite, so that a sum counts such vertices.
struct CountLost {
    View<const Vec3> x; ///< [vertices] [m]

    TOILE_HD int operator()(int i) const
    {
        const double sum = x[i][0] + x[i][1] + x[i][2];
        return sum - sum == 0.0 ? 0 : 1;
    }
};

} // namespace toile::research
