#pragma once

#include "core/compute/types.h"

namespace toile {
class CudaSpace;
} // namespace toile

namespace toile::avatars {

/// Weight of one bone at a vertex.
struct Influence {
    int bone = -1;
    double weight = 0.0; ///< [-] the weights of a vertex sum to 1
};

/// Displacement of one vertex by a blend shape of weight 1.
struct ShapeOffset {
    int shape = -1;
    Vec3 offset = Vec3(0.0, 0.0, 0.0); ///< in mesh space
};

/// A surface bound to bones, as plain data on CPU or GPU.
struct SkinView {
    View<const Vec3> rest;             ///< [vertices]     positions in mesh space, all shapes at weight 0
    View<const int> first;             ///< [vertices + 1] start of a vertex's influences
    View<const Influence> influences;  ///< [first.back()]
    View<const int> first_offset{};    ///< [vertices + 1] start of a vertex's offsets
    View<const ShapeOffset> offsets{}; ///< [first_offset.back()] empty: a surface without blend shapes
    int first_shape = 0;               ///< index among the bones of the map of shape 0
    View<const Vec3> inward{};         ///< [vertices] direction into the body, in mesh space
    View<const double> insets{}; ///< [vertices] distance that a vertex is moved inwards [m]; may be empty

    /// Linear blend skinning: a vertex moves by the weighted mean of its bones' maps, after the blend shapes.
    ///
    ///   x_v = sum_k  w_vk (A_k (r_v + sum_s m_s d_vs) + b_k)        [Magnenat-Thalmann et al. 1988]
    ///
    /// An inset vertex then moves along the blended direction inwards, sum_k w_vk A_k d_v.
    ///
    /// Bones rotated far apart shrink the joint between them ("candy wrapper"). Dual quaternions are the
    /// known remedy, and would be a second function of this form.
    /// @param bones  world_from_mesh [A_k | b_k] of every bone: from its mesh space to the posed bone in the
    ///               world. Then the map [m_s I | 0] of every blend shape, with its weight m_s.
    /// @return [m]
    TOILE_HD Vec3 posed(int v, View<const Eigen::Matrix<double, 3, 4>> bones) const
    {
        Vec3 shaped = rest[v];
        if (!offsets.empty())
            for (int k = first_offset[v]; k < first_offset[v + 1]; ++k)
                shaped += bones[first_shape + offsets[k].shape](0, 0) * offsets[k].offset;

        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Eigen::Matrix<double, 3, 4>& bone = bones[influences[k].bone];
            const Vec3 moved = bone.leftCols<3>() * shaped + bone.col(3);
            sum += influences[k].weight * moved;
        }
        return insets.empty() || insets[v] == 0.0 ? sum : Vec3(sum + insets[v] * posed_inward(v, bones));
    }

    /// Unit direction into the body at a vertex of a pose, in the world.
    TOILE_HD Vec3 posed_inward(int v, View<const Eigen::Matrix<double, 3, 4>> bones) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Vec3 turned = bones[influences[k].bone].leftCols<3>() * inward[v];
            sum += influences[k].weight * turned;
        }
        const double length = sum.norm();
        return length > 0.0 ? Vec3(sum / length) : sum;
    }
};

/// All vertices of a skin.
struct SkinVertices {
    SkinView skin;
    View<const Eigen::Matrix<double, 3, 4>> bones; // [bones] see SkinView::posed
    View<Vec3> x;                                  // [vertices] out [m]

    TOILE_HD void operator()(int v) const { x[v] = skin.posed(v, bones); }
};

/// Enqueues SkinVertices on a GPU (skinning.cu), with views of device memory. Stage "avatars/device_skin".
/// @throws DeviceError if the launch is refused.
void launch(const CudaSpace& space, const SkinVertices& kernel);

} // namespace toile::avatars
