#include "collision/repair/smoothing.h"

#include <algorithm>

namespace toile::collision {

void grow_patch(const JoinedCloths& cloths, int rings, std::vector<char>& patch)
{
    for (int ring = 0; ring < rings; ++ring) {
        const std::vector<char> inner = patch;
        for (const Triangle& corner : cloths.triangles)
            if (std::any_of(corner.begin(), corner.end(), [&](int v) { return inner[v] != 0; }))
                for (const int v : corner)
                    patch[v] = 1;
    }
}

void smooth(const JoinedCloths& cloths, const std::vector<char>& patch, int sweeps, View<Vec3> x)
{
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        std::vector<Vec3> sum(x.size(), Vec3::Zero());
        std::vector<int> count(x.size(), 0);
        for (const auto& [a, b] : cloths.edges.vertex) {
            sum[a] += x[b];
            sum[b] += x[a];
            ++count[a];
            ++count[b];
        }
        for (int v = 0; v < x.size(); ++v)
            if (patch[v] != 0 && cloths.fixed[v] == 0 && count[v] > 0)
                x[v] = 0.5 * (x[v] + sum[v] / count[v]);
    }
}

} // namespace toile::collision
