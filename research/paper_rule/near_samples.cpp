#include "research/paper_rule/near_samples.h"

#include <algorithm>

namespace toile::research {

template <int Dim>
std::vector<int> near_samples(const VoxelisedMesh<Dim>& mesh, const VoxelBox<Dim>& near, int vertex,
                              int count)
{
    std::vector<int> inside;
    for (int k = 0; k < mesh.vertex_count(); ++k)
        if (near.contains(mesh.voxel_of(k)))
            inside.push_back(k);

    std::vector<int> samples(1, vertex);
    std::vector<double> squared(inside.size(), 1e300);
    while (int(samples.size()) < std::min<int>(count, int(inside.size()))) {
        int farthest = 0;
        for (int k = 0; k < int(inside.size()); ++k) {
            squared[k] = std::min(squared[k],
                                  (mesh.position(inside[k]) - mesh.position(samples.back())).squaredNorm());
            if (squared[k] > squared[farthest])
                farthest = k;
        }
        samples.push_back(inside[farthest]);
    }
    return samples;
}

template std::vector<int> near_samples(const VoxelisedMesh<2>&, const VoxelBox<2>&, int, int);
template std::vector<int> near_samples(const VoxelisedMesh<3>&, const VoxelBox<3>&, int, int);

} // namespace toile::research
