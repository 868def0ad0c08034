#pragma once

#include <array>
#include <string>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/newton/hessian_pattern.h"
#include "garment/energy/cuda/side_blocks_kernels.h"

namespace toile::garment {

/// Second derivatives of triangles on a GPU, on their way to the blocks of a Hessian: a kernel over triangles
/// stores them by side (set_sides()), and one over edges adds those of the triangles at an edge. Same bits in
/// every run.
class DeviceSideBlocks {
public:
    /// @param name  of the energy, in errors
    DeviceSideBlocks(const CudaSpace& space, const std::string& name);

    /// Learns the positions of the edges.
    void find_entries(View<const Triangle> triangles, const HessianPattern& pattern);

    HessianBlocks sides(); ///< [3 * triangles] by 3 * triangle + corner

    /// Enqueues adding them to `blocks`.
    /// @param name       of the launch, a literal
    /// @param has_sides  [triangles] 0 for triangles that are left out; empty: all count
    void add_to(const HessianBlocks& blocks, std::string_view name, View<const unsigned char> has_sides);

private:
    const CudaSpace& space_;
    DeviceArray<int> first_, items_;
    DeviceArray<std::array<int, 2>> positions_;
    DeviceArray<Floats<4>> first_of_side_, second_of_side_;
    DeviceArray<float> last_of_side_;
};

} // namespace toile::garment
