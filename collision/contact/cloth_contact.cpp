#include "collision/contact/cloth_contact.h"

#include "collision/contact/cpu/cloth_contact.h"
#include "collision/contact/cuda/cloth_contact.h"

namespace toile::collision {

namespace {

/// Depth of facets below a round shape, relative to the gap of the cloth [-].
constexpr double kSagPerGap = 0.25;

} // namespace

std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude,
                                                 const std::vector<ContactCollider>& colliders,
                                                 bool cloth_with_cloth, const CudaSpace* space)
{
    if (space != nullptr) {
        if (!cloth_with_cloth)
            return nullptr;
        return std::make_unique<DeviceClothContact>(*space, triangles, positions, cloths, altitude);
    }
    BodySurfaces bodies(colliders, kSagPerGap * largest_gap(cloths));
    if (!cloth_with_cloth && bodies.is_empty())
        return nullptr;
    return std::make_unique<HostClothContact>(triangles, positions, cloths, altitude, std::move(bodies),
                                              cloth_with_cloth);
}

} // namespace toile::collision
