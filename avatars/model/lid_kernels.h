#pragma once

#include "core/compute/types.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::avatars {

/// Borders of the lids over cuts (ContactSurface), as plain data on CPU or GPU.
struct LidRims {
    View<const int> first; ///< [lids + 1] start of a lid's rim
    View<const int> rims;  ///< [first.back()] vertices of the body

    TOILE_HD int count() const { return first.size() - 1; }

    /// Centre of a lid: the mean of its rim [m].
    /// @param at  at(v): position of a vertex of the body [m]
    template <typename At>
    TOILE_HD Vec3 middle(int lid, const At& at) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[lid]; k < first[lid + 1]; ++k)
            sum += at(rims[k]);
        return sum / double(first[lid + 1] - first[lid]);
    }
};

/// Computes the centres of all lids, which follow the vertices of the body.
struct PlaceLids {
    LidRims lids;
    View<const Vec3> body; ///< [vertices of the body] [m]
    View<Vec3> middles;    ///< [lids] out [m]

    TOILE_HD void operator()(int lid) const
    {
        middles[lid] = lids.middle(lid, [&](int v) { return body[v]; });
    }
};

/// Enqueues PlaceLids on a GPU (skinning.cu). Stage "avatars/device_lids".
/// @throws DeviceError if the launch is refused.
void launch(const CudaSpace& space, const PlaceLids& kernel);

} // namespace toile::avatars
