#include "volume/energy/cuda/elastic_solid.h"

#include "core/compute/cuda/parallel.cuh"

namespace toile::volume {

DeviceElasticSolid::DeviceElasticSolid(const CudaSpace& space)
    : space_(space), tets_(space, "elastic/tets"), rest_inv_(space, "elastic/rest_inv"),
      volume_(space, "elastic/volume"), lame_(space, "elastic/lame"),
      first_corner_(space, "elastic/first_corner"), corners_(space, "elastic/corners"),
      corner_gradient_(space, "elastic/corner_gradient"), blocks_(space, "elastic")
{
}

void DeviceElasticSolid::add(const RestTets& rest, View<const Lame> lame, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_.first_corner.size()) && lame.size() == rest.tet_count());
    // Vertices before this solid that belong to none have no corners.
    host_.first_corner.resize(first_vertex + 1, int(host_.corners.size()));
    const int first_tet = int(host_.tets.size());
    for (const Tet& tet : rest.tets)
        host_.tets.push_back(
            {tet[0] + first_vertex, tet[1] + first_vertex, tet[2] + first_vertex, tet[3] + first_vertex});
    host_.rest_inv.insert(host_.rest_inv.end(), rest.edges_inv.begin(), rest.edges_inv.end());
    host_.volume.insert(host_.volume.end(), rest.volumes.begin(), rest.volumes.end());
    host_.lame.insert(host_.lame.end(), lame.begin(), lame.end());
    for (int v = 0; v < rest.vertex_count(); ++v) {
        for (const int corner : rest.corners_of_vertex.of(v))
            host_.corners.push_back(4 * first_tet + corner);
        host_.first_corner.push_back(int(host_.corners.size()));
    }
    tets_.upload(host_.tets);
    rest_inv_.upload(host_.rest_inv);
    volume_.upload(host_.volume);
    lame_.upload(host_.lame);
    first_corner_.upload(host_.first_corner);
    corners_.upload(host_.corners);
    corner_gradient_.resize(tets_.size());
}

void DeviceElasticSolid::add_gradient(const DeviceEvaluation& at)
{
    parallel_for(space_, "elastic/project", tets_.size(),
                 ProjectTet{solid(), at.x, corner_gradient_.view(), at.partials});
    parallel_for(space_, "elastic/gather", first_corner_.size() - 1,
                 GatherTets{first_corner_.view(), corners_.view(), corner_gradient_.view(), at.gradient});
}

void DeviceElasticSolid::find_entries(const HessianPattern& pattern)
{
    blocks_.find_entries(pairs_of(host_.tets), CurveTet::kPairs, pattern);
}

void DeviceElasticSolid::add_curvature(const DeviceCurvature& at)
{
    parallel_for(space_, "elastic/curvature", tets_.size(), CurveTet{solid(), at.x, blocks_.of_elements()});
    blocks_.add_to(at.blocks, "elastic/gather_curvature", {});
}

} // namespace toile::volume
