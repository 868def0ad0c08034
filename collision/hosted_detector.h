#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "collision/device_detect.h"

namespace toile {

/// DeviceContactDetector and the sides that it remembers, for whoever has positions and wants pairs on the
/// host.
class HostedDetector {
public:
    /// @param space                 borrowed
    /// @param triangles, positions  as ContactDetector
    /// @param partners              their numbers are those of the pairs; borrowed
    HostedDetector(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                   const std::vector<ContactPartner>& partners);

    /// Told how far in front of partner c, a mesh, each vertex is: DeviceContactDetector::in_front().
    using Learn = std::function<void(int c, View<const double> in_front)>;

    /// Appends the pairs with all partners at x [vertices] [m], as ContactDetector has them. Waits.
    /// @param reach  [vertices] see ContactDetector::move
    void detect(View<const Vec3> x, View<const double> reach, const DetectSettings& settings,
                const Learn& learn, std::vector<ContactPair>& out);

    /// As SideMemory, of the meshes that have ever moved.
    void learn_sides(View<const Vec3> x);
    void forget() { sides_.forget(); }

private:
    /// A mesh there, and where it has last been told to be.
    struct Mesh {
        /// A step as a MeshCollider knows it.
        struct Step {
            int move_count = -1;
            bool is_moving = false;
            bool operator==(const Step&) const = default;
        };
        Mesh(const CudaSpace& space, const MeshCollider& mesh);
        DeviceMeshCollider there;
        DeviceArray<Vec3> x_t0, x_t1;
        Step placed_at;
    };
    void follow(const MeshCollider& mesh, Mesh& there);

    const std::vector<ContactPartner>& partners_;
    DeviceContactDetector detector_;
    DeviceSideMemory sides_;
    std::vector<std::unique_ptr<Mesh>> meshes_; ///< [partners] null for shapes
    DeviceArray<Vec3> x_;
    DeviceArray<double> reach_;
    std::vector<double> in_front_; ///< [vertices]
};

} // namespace toile
