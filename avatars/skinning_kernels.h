#pragma once

#include "core/backend/types.h"

namespace toile {

class CudaSpace;

/// One bone's share in a vertex.
struct Influence {
    int bone = -1;
    double weight = 0.0; ///< [-] the weights of a vertex sum to 1
};

/// A surface tied to bones, as plain data on CPU or GPU.
struct SkinView {
    View<const Vec3> rest;            ///< [vertices]     positions in mesh space
    View<const int> first;            ///< [vertices + 1] where a vertex's influences begin
    View<const Influence> influences; ///< [first.back()]

    /// Linear blend skinning: a vertex moves by the weighted mean of its bones' maps.
    ///
    ///   x_v = sum_k  w_vk (A_k r_v + b_k)        [Magnenat-Thalmann et al. 1988]
    ///
    /// Bones turned far apart shrink the joint between them ("candy wrapper"); dual quaternions are the known
    /// cure, and a second function of this shape.
    /// @param bones  [bones] world_from_mesh [A_k | b_k]: from the bone's mesh space to the posed bone in the
    ///               world
    /// @return [m]
    TOILE_HD Vec3 posed(int v, View<const Eigen::Matrix<double, 3, 4>> bones) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Eigen::Matrix<double, 3, 4>& bone = bones[influences[k].bone];
            const Vec3 moved = bone.leftCols<3>() * rest[v] + bone.col(3);
            sum += influences[k].weight * moved;
        }
        return sum;
    }
};

/// All vertices of a skin.
struct SkinVertices {
    SkinView skin;
    View<const Eigen::Matrix<double, 3, 4>> bones; // [bones] see SkinView::posed
    View<Vec3> x;                                  // [vertices] out [m]

    TOILE_HD void operator()(int v) const { x[v] = skin.posed(v, bones); }
};

/// The same on a GPU, enqueued (skinning.cu): the views are of its memory. Stage "avatars/device_skin".
/// @throws DeviceError when the launch is refused.
void launch(const CudaSpace& space, const SkinVertices& kernel);

} // namespace toile
