#pragma once

#include <concepts>
#include <vector>

#include "core/compute/types.h"

namespace toile::exports {

/// A sample of all meshes of a cache, those of the first mesh before those of the next.
struct CacheSample {
    std::vector<Vec3> positions;   ///< [vertices] in the layout's axes
    std::vector<float> attributes; ///< for each of CacheMesh::attributes: [vertices of the mesh]
};

/// The same, borrowed.
struct SampleView {
    SampleView() = default;
    SampleView(const CacheSample& sample) : positions(sample.positions), attributes(sample.attributes) {}
    SampleView(const std::convertible_to<View<const Vec3>> auto& x, View<const float> values = {})
        : positions(x), attributes(values)
    {
    }

    View<const Vec3> positions;
    View<const float> attributes; ///< empty where no mesh has any
};

} // namespace toile::exports
