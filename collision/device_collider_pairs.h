#pragma once

#include <memory>
#include <vector>

#include "collision/collider_pairs.h"
#include "collision/device_detect.h"
#include "collision/device_motion_bounds.h"
#include "collision/device_pair_kernels.h"
#include "core/backend/cuda/sort.h"
#include "core/backend/cuda/sum_scratch.h"

namespace toile {

/// ColliderPairs on a GPU: the same pairs in the same order, which stay there. All views are the device's.
class DeviceColliderPairs {
public:
    /// @param space  borrowed
    /// Others as ColliderPairs; the partners are borrowed.
    DeviceColliderPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                        const std::vector<ContactPartner>& partners, const ColliderPairs::Settings& settings);

    /// All pairs at the start of a step. Waits.
    /// @param x, prediction  [vertices] see StepStart, of the device [m]
    void find(View<const Vec3> x, View<const Vec3> prediction, double dt);

    /// Nobody has strayed.
    void clear_strays() { strays_.fill_zero(); }
    /// For whoever marks more: [vertices] 1 where pairs are to be found again.
    View<unsigned char> strays() { return strays_.view(); }
    /// Marks the vertices that may touch a mesh at x where nobody has looked. True where any are marked, by
    /// whomever. Waits.
    bool mark_unseen(View<const Vec3> x);

    /// The pairs of marked vertices with meshes again, and all with shapes, from x; nothing where
    /// mark_unseen() found none. Waits.
    void find_again(View<const Vec3> x);

    void learn_sides(View<const Vec3> x); ///< see ColliderPairs
    void forget();

    bool empty() const { return partners_.empty(); }
    View<const ContactPair> all() const { return pairs_.view(); }
    PlanesOfVertices planes() const;                               ///< of all()
    View<const Vec3> found_at() const { return found_at_.view(); } ///< [vertices] see ColliderPairs [m]

private:
    /// A mesh there, and the step that it was posed for last.
    struct Mesh {
        /// A step as a MeshCollider knows it.
        struct Step {
            int move_count = -1;
            bool is_moving = false;
            bool operator==(const Step&) const = default;
        };
        Mesh(const CudaSpace& space, const MeshCollider& mesh, int vertex_count);
        void follow(const MeshCollider& mesh);

        DeviceMeshCollider there;
        std::unique_ptr<DeviceMeshPoses> poses;
        DeviceArray<Vec3> x_t0, x_t1, x_before; ///< [vertices] the last before the last move [m]
        Bounds box;                             ///< around x_t1 [m]
        DeviceMotionBounds motion;              ///< of the last move
        Step placed_at;
        DeviceArray<Vec3> clear_at;    ///< [vertices] of the clearance: Clearance [m]
        DeviceArray<double> clearance; ///< [vertices] [m]
        int clear_since = -2;          ///< of the clearance, moves of the mesh
    };
    void follow_partners();
    void follow_clearance(int c, View<const Vec3> x);
    void look(View<const Vec3> x, double radius, const Surroundings* around);
    void look_at(int c, View<const Vec3> x, const Surroundings* around, const DetectSettings& settings);
    bool is_beyond(int c, const Surroundings& around, const DetectSettings& settings) const;
    void append(View<const ContactPair> found);
    void sort_planes();

    const CudaSpace& space_;
    std::vector<ContactPartner> partners_;
    ColliderPairs::Settings settings_;
    DeviceContactDetector detector_;
    DeviceSideMemory sides_;
    std::vector<std::unique_ptr<Mesh>> meshes_; ///< [partners] null for shapes
    DeviceArray<CarryingPartner> carrying_;     ///< [partners]
    double farthest_motion_ = 0.0;              ///< see ColliderPairs [m]
    bool has_strays_ = false;

    DeviceArray<ContactPair> pairs_, kept_;
    DeviceArray<Vec3> found_at_;          ///< [vertices] [m]
    DeviceArray<double> reach_, wanted_;  ///< [vertices] [m]
    DeviceArray<NearestSurface> nearest_; ///< [vertices] last step's
    DeviceArray<unsigned char> strays_;   ///< [vertices]
    DeviceArray<unsigned char> flags_;    ///< [pairs]
    DeviceArray<int> list_;               ///< [pairs] scratch
    SortArrays planes_;                   ///< [pairs] by vertex
    DeviceArray<int> plane_pairs_, first_plane_;
    SumScratch<Surroundings> surroundings_;
    SumScratch<int> stray_count_;
    PinnedArray<int> count_;
    DeviceScratch scratch_;
};

} // namespace toile
