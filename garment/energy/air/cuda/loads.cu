#include "garment/energy/air/cuda/loads.h"

#include <algorithm>

#include "core/compute/cuda/parallel.cuh"

namespace toile::garment {

DeviceLoads::DeviceLoads(const CudaSpace& space, const Settings& settings, const Gusts& gusts)
    : space_(space), settings_(settings), modes_(space, "loads/modes"), triangles_(space, "loads/triangles"),
      cloth_(space, "loads/cloth"), first_corner_(space, "loads/first_corner"),
      corners_(space, "loads/corners"), masses_(space, "loads/masses"), damping_(space, "loads/damping"),
      drag_(space, "loads/drag"), gusts_(space, "loads/gusts")
{
    modes_.upload(gusts.modes());
}

void DeviceLoads::add(const RestShape& rest, View<const double> masses, double damping, int first_vertex)
{
    TOILE_ASSERT(first_vertex >= int(host_.cloth.size()) && masses.size() == rest.vertex_count());
    resize(first_vertex);
    const int first_triangle = int(host_.triangles.size());
    for (const Triangle& corner : rest.triangles)
        host_.triangles.push_back(corner + Triangle::Constant(first_vertex));
    for (int v = 0; v < rest.vertex_count(); ++v) {
        for (const int corner : rest.topology.corners_of_vertex.of(v))
            host_.corners.push_back(3 * first_triangle + corner);
        host_.first_corner.push_back(int(host_.corners.size()));
        host_.cloth.push_back(int(host_.damping.size()));
    }
    host_.masses.insert(host_.masses.end(), masses.begin(), masses.end());
    host_.damping.push_back(damping);
    upload();
}

void DeviceLoads::add_without_air(View<const int> vertices, double damping)
{
    resize(std::max(int(host_.cloth.size()), 1 + *std::max_element(vertices.begin(), vertices.end())));
    for (const int v : vertices)
        host_.cloth[v] = int(host_.damping.size());
    host_.damping.push_back(damping);
    upload();
}

/// New vertices belong to no cloth and have no corners.
void DeviceLoads::resize(int vertex_count)
{
    host_.cloth.resize(vertex_count, -1);
    host_.masses.resize(vertex_count, 1.0);
    host_.first_corner.resize(vertex_count + 1, int(host_.corners.size()));
}

void DeviceLoads::upload()
{
    cloth_.upload(host_.cloth);
    masses_.upload(host_.masses);
    damping_.upload(host_.damping);
    first_corner_.upload(host_.first_corner);
    if (!settings_.air.is_active())
        return;
    triangles_.upload(host_.triangles);
    corners_.upload(host_.corners);
    drag_.resize(triangles_.size());
    if (modes_.size() > 0)
        gusts_.resize(cloth_.size());
}

void DeviceLoads::accelerate(double dt, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration)
{
    TOILE_ASSERT(x.size() == cloth_.size() && v.size() == x.size() && acceleration.size() == x.size());
    if (!is_loaded_) {
        parallel_for(space_, "loads/none", x.size(), NoLoad{acceleration});
        return;
    }
    parallel_for(space_, "loads/gusts", gusts_.size(), SampleGusts{modes_.view(), x, t_t1_, gusts_.view()});
    parallel_for(
        space_, "loads/drag", triangles_.size(),
        DragOfTriangle{x, v, triangles_.view(), settings_.wind, gusts_.view(), settings_.air, drag_.view()});
    parallel_for(space_, "loads/vertices", x.size(),
                 LoadVertex{{settings_.gravity, v, acceleration},
                            cloth_.view(),
                            damping_.view(),
                            settings_.air.is_active(),
                            {v, masses_.view(), first_corner_.view(), corners_.view(), drag_.view(),
                             settings_.wind, gusts_.view(), dt, acceleration}});
}

} // namespace toile::garment
