#include "research/paper_rule/near_samples.h"

#include <algorithm>

namespace toile::research {

std::vector<int> near_samples(const UvSurface& surface, const PixelBox& near, int vertex, int count)
{
    std::vector<int> inside;
    for (int k = 0; k < surface.vertex_count(); ++k)
        if (near.contains(surface.pixel_of(k)))
            inside.push_back(k);

    std::vector<int> samples(1, vertex);
    std::vector<double> squared(inside.size(), 1e300);
    while (int(samples.size()) < std::min<int>(count, int(inside.size()))) {
        int farthest = 0;
        for (int k = 0; k < int(inside.size()); ++k) {
            squared[k] =
                std::min(squared[k], (surface.uv(inside[k]) - surface.uv(samples.back())).squaredNorm());
            if (squared[k] > squared[farthest])
                farthest = k;
        }
        samples.push_back(inside[farthest]);
    }
    return samples;
}

} // namespace toile::research
