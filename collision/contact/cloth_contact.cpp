#include "collision/contact/cloth_contact.h"

#include "collision/contact/cpu/cloth_contact.h"
#include "collision/contact/cuda/cloth_contact.h"

namespace toile::collision {

std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude, const CudaSpace* space)
{
    if (space != nullptr)
        return std::make_unique<DeviceClothContact>(*space, triangles, positions, cloths, altitude);
    return std::make_unique<HostClothContact>(triangles, positions, cloths, altitude);
}

} // namespace toile::collision
