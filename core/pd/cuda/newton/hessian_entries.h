#pragma once

#include "core/compute/lanes.h"

namespace toile {

/// 3 x 3 blocks by position (HessianPattern), in arrays whose loads are contiguous [N/m].
struct HessianBlocks {
    View<Floats<4>> first, second; ///< row by row: entries 0 to 3, 4 to 7
    View<float> last;              ///< entry 8

    using Block = Eigen::Matrix3f;

    TOILE_HD Block operator[](int position) const
    {
        const Floats<4> a = first[position], b = second[position];
        Block block;
        block(0, 0) = a[0];
        block(0, 1) = a[1];
        block(0, 2) = a[2];
        block(1, 0) = a[3];
        block(1, 1) = b[0];
        block(1, 2) = b[1];
        block(2, 0) = b[2];
        block(2, 1) = b[3];
        block(2, 2) = last[position];
        return block;
    }
    TOILE_HD void set(int position, const Block& block) const
    {
        first[position] = Floats<4>(block(0, 0), block(0, 1), block(0, 2), block(1, 0));
        second[position] = Floats<4>(block(1, 1), block(1, 2), block(2, 0), block(2, 1));
        last[position] = block(2, 2);
    }
    TOILE_HD void add(int position, const Block& block) const
    {
        set(position, Block((*this)[position] + block));
    }
};

/// Entries of a Hessian on a GPU, to which the energies add their second derivatives at x; see
/// HessianPattern. An entry belongs to one thread of a kernel.
struct DeviceCurvature {
    View<const Vec3> x;   ///< [vertices] [m]
    HessianBlocks blocks; ///< by position [N/m]
    View<float> scalars;  ///< by position: begins with the constant part [N/m]
    View<double> sum;     ///< [vertices] S: begins with the inertia [N/m]
};

} // namespace toile
