#include "research/methods/xpbd/cuda/xpbd.h"

#include <string>
#include <utility>

#include "core/base/error.h"
#include "core/compute/cuda/teams.cuh"
#include "research/methods/bending_forces.h"
#include "research/methods/xpbd/xpbd_kernels.h"

namespace toile::research {

namespace {

/// Threads per block: colours are small, and a few blocks per multiprocessor hide each other's latency.
constexpr int kBlock = 64;

} // namespace

template <typename T>
DeviceXpbd<T>::DeviceXpbd(const CudaSpace& space, const std::vector<Vec3>& positions,
                          const garment::ClothModel& cloth, const Settings& settings)
    : DeviceXpbd(space, positions, ConstraintTable<T>(cloth), settings)
{
}

template <typename T>
DeviceXpbd<T>::DeviceXpbd(const CudaSpace& space, const std::vector<Vec3>& positions,
                          ConstraintTable<T> table, const Settings& settings)
    : DeviceBaselineMethod(space, positions, table.masses), settings_(settings), table_(std::move(table)),
      first_entry_(space, "xpbd/first_entry"), bending_(space, "xpbd/bending"),
      strains_(space, "xpbd/strains"), curvatures_(space, "xpbd/curvatures"),
      entries_(space, "xpbd/entries"), particles_{{space, "xpbd/particles", vertex_count()},
                                                  {space, "xpbd/particles", vertex_count()}}
{
    if (settings.substeps < 1)
        throw InvalidInput("DeviceXpbd: substeps = " + std::to_string(settings.substeps) +
                           "; it must be 1 or more");
    first_entry_.upload(table_.bending.first);
    bending_.upload(table_.bending.entries);
    strains_.upload(table_.strains);
    curvatures_.upload(table_.curvatures);
    entries_.upload(table_.entries);
}

template <typename T>
void DeviceXpbd<T>::enqueue(double dt, const Fields& fields)
{
    const double h = dt / settings_.substeps;
    const bool bends_by_forces = settings_.bend_by_forces && allows_bending_forces(table_.fastest_bending, h);
    View<Particle> before = particles_[0].view(), after = particles_[1].view();
    parallel_for(space(), "xpbd/begin", vertex_count(),
                 BeginParticle{fields.x, fields.mobility, after, before});
    for (int s = 1; s <= settings_.substeps; ++s) {
        std::swap(before, after);
        parallel_for_teams<SlicedRows::kThreads>(
            space(), "xpbd/predict", vertex_count(),
            PredictParticle{bends_by_forces ? std::as_const(first_entry_).view() : View<const int>(),
                            bending_.view(), fields.v, fields.acceleration, fields.x, fields.targets, h,
                            double(s) / settings_.substeps, s == 1, before, after});
        enqueue_constraints(h, bends_by_forces, after);
    }
    parallel_for(space(), "xpbd/end", vertex_count(), EndParticle{before, after, h, fields.x, fields.v});
}

/// Enqueues one pass over the constraints, the stiff ones last.
template <typename T>
void DeviceXpbd<T>::enqueue_constraints(double h, bool bends_by_forces, View<Particle> after)
{
    const View<const CurvatureItem<T>> curvatures = curvatures_.view();
    if (!bends_by_forces)
        for (const BlockRange& colour : table_.curvature_colours)
            parallel_for(space(), "xpbd/curvatures", colour.count,
                         ProjectCurvatureItem<T>{curvatures.subview(colour.first, colour.count),
                                                 entries_.view(), h, after},
                         kBlock);
    const View<const StrainItem<T>> strains = strains_.view();
    for (const BlockRange& colour : table_.strain_colours)
        parallel_for(
            space(), "xpbd/strains", colour.count,
            ProjectStrainItem<T>{strains.subview(colour.first, colour.count), table_.weights, h, after},
            kBlock);
}

template class DeviceXpbd<float>;
template class DeviceXpbd<double>;

} // namespace toile::research
