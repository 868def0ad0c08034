#pragma once

#include <memory>
#include <vector>

#include "collision/body/collider_pairs.h"
#include "collision/body/cuda/detect.h"
#include "collision/body/cuda/pair_kernels.h"
#include "collision/bvh/cuda/motion_bounds.h"
#include "core/compute/cuda/sort.h"
#include "core/compute/cuda/sum_scratch.h"

namespace toile::collision {

/// ColliderPairs on a GPU: the same pairs in the same order, stored on the device. All views are on the
/// device.
class DeviceColliderPairs {
public:
    /// Parameters as in ColliderPairs; the colliders are borrowed.
    /// @param space  borrowed
    DeviceColliderPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                        const std::vector<ContactCollider>& colliders,
                        const ColliderPairs::Settings& settings);

    /// Advects positions x [vertices] at t0 with the nearest surfaces: found_at() [m].
    void advect(View<const Vec3> x, double dt);

    /// Finds all pairs at the start of a step. Waits.
    /// @param x, prediction  [vertices] see StepStart, on the device [m]
    /// @param from           [vertices] positions around which they are searched for [m]; empty: advect()
    void find(View<const Vec3> x, View<const Vec3> prediction, double dt, View<const Vec3> from = {});

    /// Clears all marks of out-of-bounds vertices.
    void clear_out_of_bounds() { out_of_bounds_.fill_zero(); }
    /// [vertices] Marks that other code may set; 1: pairs are to be found again.
    View<unsigned char> out_of_bounds() { return out_of_bounds_.view(); }
    /// Marks vertices that may be in contact with a mesh outside the region searched for them. True if any
    /// vertex is marked, here or by other code. Waits.
    bool mark_unseen(View<const Vec3> x);

    /// Searches again from x: marked vertices against meshes, all against shapes. Does nothing if
    /// mark_unseen() found none. Waits.
    void find_again(View<const Vec3> x);

    void update_sides(View<const Vec3> x); ///< see ColliderPairs
    void forget();

    bool empty() const { return colliders_.empty(); }
    View<const ContactPair> all() const { return pairs_.view(); }
    PlanesOfVertices planes() const;                               ///< of all()
    View<const Vec3> found_at() const { return found_at_.view(); } ///< [vertices] see ColliderPairs [m]

    /// Copies [vertices] found_at() and the nearest surfaces of the last search, as DeviceArray::download.
    void download_found_at(View<Vec3> out) const { found_at_.download(out); }
    void download_nearest(View<NearestSurface> out) const { nearest_.download(out); }

private:
    /// Mesh on the device, with the step of its last pose.
    struct Mesh {
        /// Step of a MeshCollider.
        struct Step {
            int move_count = -1;
            bool is_moving = false;
            bool operator==(const Step&) const = default;
        };
        Mesh(const CudaSpace& space, const MeshCollider& mesh, int vertex_count);
        void follow(const MeshCollider& mesh);

        DeviceMeshCollider device_mesh;
        std::unique_ptr<DeviceMeshPoses> poses;
        DeviceArray<Vec3> x_t0, x_t1, x_before; ///< [vertices] x_before: before the last move [m]
        Bounds box;                             ///< of x_t1 [m]
        DeviceMotionBounds motion;              ///< of the last move
        Step placed_at;
        DeviceArray<Vec3> clear_at;    ///< [vertices] positions of the clearance [m]
        DeviceArray<double> clearance; ///< [vertices] [m]
        int clear_since = -2;          ///< move_count() of the mesh at the clearance
    };
    void follow_colliders();
    void follow_clearance(int c, View<const Vec3> x);
    void search(View<const Vec3> x, const QueryBounds* bounds);
    void search_collider(int c, View<const Vec3> x, const QueryBounds* bounds,
                         const DetectSettings& settings);
    bool is_beyond(int c, const QueryBounds& bounds, const DetectSettings& settings) const;
    void append(View<const ContactPair> found);
    void sort_planes();

    const CudaSpace& space_;
    std::vector<ContactCollider> colliders_;
    ColliderPairs::Settings settings_;
    DeviceContactDetector detector_;
    DeviceContactSideHistory sides_;
    std::vector<std::unique_ptr<Mesh>> meshes_;          ///< [colliders] null for shapes
    DeviceArray<AdvectingCollider> advecting_colliders_; ///< [colliders]
    double max_motion_ = 0.0, shape_radius_ = 0.0;       ///< see ColliderPairs [m]
    bool has_out_of_bounds_ = false;

    DeviceArray<ContactPair> pairs_, kept_;
    DeviceArray<Vec3> found_at_;               ///< [vertices] [m]
    DeviceArray<double> reach_, wanted_;       ///< [vertices] [m]
    DeviceArray<NearestSurface> nearest_;      ///< [vertices] of the last step
    DeviceArray<unsigned char> out_of_bounds_; ///< [vertices]
    DeviceArray<unsigned char> flags_;         ///< [pairs]
    DeviceArray<int> list_;                    ///< [pairs] scratch
    SortArrays planes_;                        ///< [pairs] by vertex
    DeviceArray<int> plane_pairs_, first_plane_;
    SumScratch<QueryBounds> query_bounds_;
    SumScratch<int> out_of_bounds_count_;
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile::collision
