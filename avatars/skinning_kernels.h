#pragma once

#include "core/backend/types.h"

namespace toile {

class CudaSpace;

/// One bone's share in a vertex.
struct Influence {
    int bone = -1;
    double weight = 0.0; ///< [-] the weights of a vertex sum to 1
};

/// Linear blend skinning: every vertex moves by the weighted mean of its bones' maps.
///
///   x_v = sum_k  w_vk (A_k r_v + b_k)        [Magnenat-Thalmann et al. 1988]
///
/// [A_k | b_k] takes the bone's mesh space to the posed bone in world space. Bones turned far apart shrink
/// the joint between them ("candy wrapper"); dual quaternions are the known cure, and a second kernel of this
/// shape.
struct SkinVertices {
    View<const Vec3> rest;                         // [vertices]     positions in mesh space
    View<const int> first;                         // [vertices + 1] where a vertex's influences begin
    View<const Influence> influences;              // [first.back()]
    View<const Eigen::Matrix<double, 3, 4>> bones; // [bones]        world_from_mesh [A | b]
    View<Vec3> x;                                  // [vertices]     out: posed positions [m]

    TOILE_HD void operator()(int v) const
    {
        Vec3 sum(0.0, 0.0, 0.0);
        for (int k = first[v]; k < first[v + 1]; ++k) {
            const Eigen::Matrix<double, 3, 4>& bone = bones[influences[k].bone];
            const Vec3 moved = bone.leftCols<3>() * rest[v] + bone.col(3);
            sum += influences[k].weight * moved;
        }
        x[v] = sum;
    }
};

/// A rigid or scaled copy: x_v = A r_v + b.
struct PlaceVertices {
    View<const Vec3> rest;             // [vertices]
    Eigen::Matrix<double, 3, 4> place; // [A | b]
    View<Vec3> x;                      // [vertices] out [m]

    TOILE_HD void operator()(int v) const
    {
        const Vec3 moved = place.leftCols<3>() * rest[v] + place.col(3);
        x[v] = moved;
    }
};

/// The same on a GPU, enqueued (skinning.cu): the views are of its memory. Stages "avatars/skin" and
/// "avatars/place".
/// @throws DeviceError when the launch is refused.
void launch(const CudaSpace& space, const SkinVertices& kernel);
void launch(const CudaSpace& space, const PlaceVertices& kernel);

} // namespace toile
