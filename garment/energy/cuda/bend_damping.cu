#include "garment/energy/cuda/bend_damping.h"

#include "core/compute/cuda/teams.cuh"
#include "core/pd/cuda/newton/hessian_pattern.h"
#include "core/pd/cuda/newton/pair_lists.h"

namespace toile::garment {

namespace {

/// Threads per vertex, which has about twelve slots.
constexpr int kTeam = 4;

/// Pairs of the vertices of a hinge, as slots.
constexpr int kPairs = 6;
constexpr std::array<int, 2> kSlotsOfPair[kPairs] = {{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}};

} // namespace

DeviceBendDamping::DeviceBendDamping(const CudaSpace& space)
    : space_(space), hinges_(space, "bend_damping/hinges"), first_(space, "bend_damping/first"),
      slots_(space, "bend_damping/slots"), dt_(space, "bend_damping/dt", 1),
      start_(space, "bend_damping/start"), force_(space, "bend_damping/force"),
      stiffness_(space, "bend_damping/stiffness"), pair_first_(space, "bend_damping/pair_first"),
      pair_weights_(space, "bend_damping/pair_weights"), positions_(space, "bend_damping/positions")
{
}

void DeviceBendDamping::add(const std::vector<Hinge>& hinges, const Incidence& slots, int first_vertex)
{
    TOILE_ASSERT(first_vertex + 1 >= int(host_first_.size()));
    // Vertices before this cloth that belong to no cloth have no hinges.
    host_first_.resize(first_vertex + 1, int(host_slots_.size()));
    const int first_hinge = int(host_hinges_.size());
    for (Hinge hinge : hinges) {
        for (int& v : hinge.vertex)
            v += first_vertex;
        host_hinges_.push_back(hinge);
    }
    for (int v = 0; v + 1 < int(slots.first.size()); ++v) {
        for (const int slot : slots.of(v))
            host_slots_.push_back(4 * first_hinge + slot);
        host_first_.push_back(int(host_slots_.size()));
    }
    hinges_.upload(host_hinges_);
    first_.upload(host_first_);
    slots_.upload(host_slots_);
    dt_.fill_zero();
    start_.resize(hinges_.size());
    start_.fill_zero();
    force_.resize(4 * hinges_.size());
    stiffness_.resize(hinges_.size());
}

HingesInStep DeviceBendDamping::in_step(View<const Vec3> x) const
{
    return {hinges_.view(), dt_.view(), start_.view(), x};
}

void DeviceBendDamping::begin_step(View<const Vec3> x, double dt)
{
    dt_.upload(View<const double>(&dt, 1));
    parallel_for(space_, "bend_damping/start", hinges_.size(), StartHinge{in_step(x), start_.view()});
}

void DeviceBendDamping::add_gradient(const DeviceEvaluation& at)
{
    parallel_for(space_, "bend_damping/fold", hinges_.size(),
                 PullHinge{in_step(at.x), force_.view(), at.partials});
    parallel_for_teams<kTeam>(space_, "bend_damping/gather", first_.size() - 1,
                              GatherHinges{first_.view(), slots_.view(), force_.view(), at.gradient});
}

void DeviceBendDamping::find_entries(const HessianPattern& pattern)
{
    std::vector<std::array<int, 2>> pair_of_item;
    for (const Hinge& hinge : host_hinges_)
        for (const auto& [k, l] : kSlotsOfPair)
            pair_of_item.push_back({hinge.vertex[k], hinge.vertex[l]});
    const PairLists lists(pair_of_item, [&](int i, int j) { return pattern.scalar_position(i, j); });
    std::vector<RowEntry> weights;
    for (const int item : lists.items) {
        const Hinge& hinge = host_hinges_[item / 2 / kPairs];
        const auto [k, l] = kSlotsOfPair[item / 2 % kPairs];
        weights.push_back({item / 2 / kPairs, float(hinge.weight[k] * hinge.weight[l])});
    }
    pair_first_.upload(lists.first);
    pair_weights_.upload(weights);
    positions_.upload(lists.positions);
}

void DeviceBendDamping::add_curvature(const DeviceCurvature& at)
{
    parallel_for(space_, "bend_damping/stiffness", hinges_.size(),
                 StiffenHinge{in_step(at.x), stiffness_.view()});
    parallel_for(space_, "bend_damping/scalars", positions_.size(),
                 AddHingeStiffness{pair_first_.view(), pair_weights_.view(), positions_.view(),
                                   stiffness_.view(), at.scalars});
}

} // namespace toile::garment
