#include "collision/cloth/cloth_contact.h"

#include "collision/cloth/device_cloth_contact.h"
#include "collision/cloth/host_cloth_contact.h"

namespace toile {

std::unique_ptr<ClothContact> make_cloth_contact(View<const Triangle> triangles, View<const Vec3> positions,
                                                 const std::vector<ContactCloth>& cloths,
                                                 View<const double> altitude, const CudaSpace* space)
{
    if (space != nullptr)
        return std::make_unique<DeviceClothContact>(*space, triangles, positions, cloths, altitude);
    return std::make_unique<HostClothContact>(triangles, positions, cloths, altitude);
}

} // namespace toile
