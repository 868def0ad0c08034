#pragma once

#include <vector>

#include "collision/cloth/device_near_pairs.h"

namespace toile {

/// DeviceNearPairs for whoever has positions and wants pairs on the host.
class HostedNearPairs {
public:
    /// As DeviceNearPairs.
    HostedNearPairs(const CudaSpace& space, View<const Triangle> triangles, View<const Vec3> positions,
                    View<const int> rigid);

    /// As NearPairs::find. Waits.
    void find(View<const Vec3> x, const Ways& ways, double margin, std::vector<NearPair>& out);

    DeviceNearPairs& there() { return there_; }

private:
    DeviceNearPairs there_;
    DeviceArray<Vec3> x_, motion_;
    DeviceArray<double> slack_;
    DeviceArray<unsigned char> around_;
};

} // namespace toile
