#pragma once

#include "core/backend/types.h"

namespace toile {

/// 1 where a vertex is nowhere.
struct CountLost {
    View<const Vec3> x; ///< [vertices] [m]

    TOILE_HD int operator()(int i) const
    {
        const double sum = x[i][0] + x[i][1] + x[i][2];
        return sum - sum == 0.0 ? 0 : 1;
    }
};

} // namespace toile
