#include "collision/body/given_poses.h"

#include <algorithm>

#include "core/compute/cuda/array.h"

namespace toile::collision {

namespace {

class DeviceGivenPoses final : public DeviceMeshPoses {
public:
    explicit DeviceGivenPoses(const GivenPoses& given) : given_(given) {}
    void pose_t0(DeviceArray<Vec3>& x) override { x.upload(given_.x_t0()); }
    void pose_t1(DeviceArray<Vec3>& x) override { x.upload(given_.x_t1()); }

private:
    const GivenPoses& given_;
};

} // namespace

bool GivenPoses::move(const MovingMesh& mesh)
{
    TOILE_ASSERT(mesh.x_t1.size() == x_t1_.size());
    const bool is_moving = mesh.x_t1 != x_t1_;
    x_t0_ = mesh.x_t0;
    x_t1_ = mesh.x_t1;
    return is_moving;
}

void GivenPoses::pose_t0(View<Vec3> x) const { std::copy(x_t0_.begin(), x_t0_.end(), x.begin()); }
void GivenPoses::pose_t1(View<Vec3> x) const { std::copy(x_t1_.begin(), x_t1_.end(), x.begin()); }

std::unique_ptr<DeviceMeshPoses> GivenPoses::on_device(const CudaSpace&) const
{
    return std::make_unique<DeviceGivenPoses>(*this);
}

} // namespace toile::collision
