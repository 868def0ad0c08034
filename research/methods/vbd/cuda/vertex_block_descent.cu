#include "research/methods/vbd/cuda/vertex_block_descent.h"

#include "core/compute/cuda/teams.cuh"
#include "research/methods/vbd/sweep_kernels.h"

namespace toile::research {

namespace {

/// Threads per vertex, which has about six triangles and 22 entries of K.
constexpr int kTeam = 8;

} // namespace

template <typename T>
DeviceVertexBlockDescent<T>::DeviceVertexBlockDescent(const CudaSpace& space,
                                                      const std::vector<Vec3>& positions,
                                                      const garment::ClothModel& cloth,
                                                      const Settings& settings)
    : DeviceVertexBlockDescent(space, positions, SweepTable<T>(cloth, settings.lags_bending), settings)
{
}

template <typename T>
DeviceVertexBlockDescent<T>::DeviceVertexBlockDescent(const CudaSpace& space,
                                                      const std::vector<Vec3>& positions,
                                                      const SweepTable<T>& table, const Settings& settings)
    : DeviceBaselineMethod(space, positions, table.masses), settings_(settings), weights_(table.weights),
      colours_(table.colours), items_(space, "vbd/items"), triangles_(space, "vbd/triangles"),
      bends_(space, "vbd/bends"), first_entry_(space, "vbd/first_entry"), bending_(space, "vbd/bending"),
      lagged_(space, "vbd/lagged"), particles_(space, "vbd/particles", vertex_count()),
      prediction_(space, "vbd/prediction", vertex_count()), v_before_(space, "vbd/v_before"),
      last_(space, "vbd/last"), before_last_(space, "vbd/before_last")
{
    items_.upload(table.items);
    triangles_.upload(table.triangles);
    bends_.upload(table.bends);
    v_before_.upload(std::vector<Vec3>(positions.size(), Vec3::Zero()));
    if (settings.lags_bending) {
        first_entry_.upload(table.bending.first);
        bending_.upload(table.bending.entries);
        lagged_.resize(vertex_count());
    }
    if (settings.rho > 0.0) {
        last_.resize(vertex_count());
        before_last_.resize(vertex_count());
    }
}

template <typename T>
void DeviceVertexBlockDescent<T>::enqueue(double dt, const Fields& fields)
{
    BeginSweeps begin{fields.x,
                      fields.v,
                      {},
                      fields.acceleration,
                      fields.targets,
                      fields.mobility,
                      dt,
                      particles_.view(),
                      prediction_.view(),
                      last_.view(),
                      before_last_.view()};
    if (settings_.adaptive_start)
        begin.v_before = v_before_.view();
    parallel_for(space(), "vbd/begin", vertex_count(), begin);

    const double rho2 = settings_.rho * settings_.rho;
    double omega = 1.0;
    for (int sweep = 1; sweep <= settings_.max_sweeps; ++sweep) {
        enqueue_sweep(dt);
        if (settings_.rho == 0.0)
            continue;
        omega = sweep == 1 ? 1.0 : sweep == 2 ? 2.0 / (2.0 - rho2) : 4.0 / (4.0 - rho2 * omega);
        parallel_for(space(), "vbd/accelerate", vertex_count(),
                     AccelerateSweep{omega, particles_.view(), last_.view(), before_last_.view()});
    }
    parallel_for(space(), "vbd/end", vertex_count(),
                 EndSweeps{particles_.view(), dt, fields.x, fields.v, v_before_.view()});
}

template <typename T>
void DeviceVertexBlockDescent<T>::enqueue_sweep(double dt)
{
    if (settings_.lags_bending)
        parallel_for_teams<SlicedRows::kThreads>(
            space(), "vbd/lag_bending", vertex_count(),
            LagBending{first_entry_.view(), bending_.view(), particles_.view(), lagged_.view()});
    const View<const SweepItem<T>> items = items_.view();
    for (const BlockRange& colour : colours_)
        parallel_for_teams<kTeam>(space(), "vbd/sweep", colour.count,
                                  DescendVertex<T>{items.subview(colour.first, colour.count),
                                                   triangles_.view(), bends_.view(), lagged_.view(), weights_,
                                                   dt, prediction_.view(), particles_.view()});
}

template class DeviceVertexBlockDescent<float>;
template class DeviceVertexBlockDescent<double>;

} // namespace toile::research
