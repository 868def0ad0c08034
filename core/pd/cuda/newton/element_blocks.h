#pragma once

#include <array>
#include <string>
#include <vector>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/newton/element_blocks_kernels.h"
#include "core/pd/cuda/newton/hessian_pattern.h"

namespace toile {

/// Second derivatives of elements, triangles or tetrahedra, between their vertices on a GPU, on their way to
/// the blocks of a Hessian: a kernel over elements stores them by pair of corners, and one over pairs of
/// vertices adds those of the elements there. Same bits in every run.
class DeviceElementBlocks {
public:
    /// @param name  of the energy, in errors
    DeviceElementBlocks(const CudaSpace& space, const std::string& name);

    /// Learns the positions of the entries.
    /// @param pairs       [elements * of_element] two vertices of an element: its block is that of (first,
    /// second)
    /// @param of_element  pairs of an element
    void find_entries(const std::vector<std::array<int, 2>>& pairs, int of_element,
                      const HessianPattern& pattern);

    HessianBlocks of_elements(); ///< [pairs]

    /// Enqueues adding them to `blocks`.
    /// @param name        of the launch, a literal
    /// @param has_blocks  [elements] 0 for elements that are left out; empty: all count
    void add_to(const HessianBlocks& blocks, std::string_view name, View<const unsigned char> has_blocks);

private:
    const CudaSpace& space_;
    int of_element_ = 1;
    DeviceArray<int> first_, items_;
    DeviceArray<std::array<int, 2>> positions_;
    DeviceArray<Floats<4>> first_part_, second_part_;
    DeviceArray<float> last_part_;
};

} // namespace toile
