#include "garment/energy/air/aerodynamics.h"

#include <utility>

#include "core/compute/parallel.h"

namespace toile::garment {

Aerodynamics::Aerodynamics(std::shared_ptr<const RestShape> rest, const Settings& settings)
    : rest_(std::move(rest)), settings_(settings), drag_(rest_->triangles.size())
{
}

void Aerodynamics::add_acceleration(View<const Vec3> x, View<const Vec3> v, View<const double> masses,
                                    const Vec3& wind, double dt, View<Vec3> acceleration,
                                    View<const Vec3> gusts)
{
    const StageScope stage("garment/aerodynamics");
    parallel_for(kCpu, "aerodynamics/triangles", int(drag_.size()),
                 DragOfTriangle{x, v, rest_->triangles, wind, gusts, settings_, drag_});
    const Incidence& corners = rest_->topology.corners_of_vertex;
    parallel_for(
        kCpu, "aerodynamics/vertices", x.size(),
        AccelerateByDrag{v, masses, corners.first, corners.items, drag_, wind, gusts, dt, acceleration});
}

} // namespace toile::garment
