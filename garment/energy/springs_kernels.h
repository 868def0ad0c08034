#pragma once

#include "core/compute/types.h"

namespace toile::garment {

/// A spring of zero rest length between a vertex and a target position.
struct AnchorSpring {
    int vertex = 0;
    double stiffness = 0.0;            ///< [N/m]
    Vec3 target = Vec3(0.0, 0.0, 0.0); ///< [m]

    /// Adds its gradient [N]; returns its energy [J].
    TOILE_HD double pull(View<const Vec3> x, View<Vec3> gradient) const
    {
        const Vec3 stretch = x[vertex] - target;
        gradient[vertex] += stiffness * stretch;
        return 0.5 * stiffness * stretch.squaredNorm();
    }
};

/// Gradient and energy of the springs of the k-th attached vertex.
struct PullAnchoredVertex {
    View<const AnchorSpring> springs; ///< ascending by vertex
    View<const int> first;            ///< [attached vertices + 1]
    View<const Vec3> x;               ///< [vertices] [m]
    View<Vec3> gradient;              ///< [vertices] added to [N]
    View<double> energy;              ///< [vertices] added to [J]

    TOILE_HD void operator()(int k) const
    {
        for (int j = first[k]; j < first[k + 1]; ++j)
            energy[springs[j].vertex] += springs[j].pull(x, gradient);
    }
};

/// Stiffness of the springs of the k-th attached vertex against its translation.
struct StiffenAnchoredVertex {
    View<const AnchorSpring> springs; ///< ascending by vertex
    View<const int> first;            ///< [attached vertices + 1]
    View<double> sum;                 ///< [vertices] added to [N/m]

    TOILE_HD void operator()(int k) const
    {
        for (int j = first[k]; j < first[k + 1]; ++j)
            sum[springs[j].vertex] += springs[j].stiffness;
    }
};

} // namespace toile::garment
