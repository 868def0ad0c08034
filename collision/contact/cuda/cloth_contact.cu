#include "collision/contact/cuda/cloth_contact.h"

#include <algorithm>

#include "collision/geometry/surface_edges.h"
#include "core/compute/cuda/parallel.cuh"
#include "core/pd/cuda/body_kernels.h"

namespace toile::collision {

namespace {

ExemptPairs exempt_pairs(View<const Vec3> positions, View<const double> altitude)
{
    return {positions, altitude, CollisionFreeStep::Settings{}.min_gap};
}

} // namespace

DeviceClothContact::DeviceClothContact(const CudaSpace& space, View<const Triangle> triangles,
                                       View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                       View<const double> altitude)
    : ClothContact({triangles, positions, cloths, altitude}), space_(space),
      half_thickness_(space, "cloth_contact/half_thickness"),
      slack_(space, "cloth_contact/slack", positions.size()),
      base_(space, "cloth_contact/base", positions.size()),
      deviation_(space, "cloth_contact/deviation", positions.size()),
      motion_(space, "cloth_contact/motion", positions.size()),
      expected_(space, "cloth_contact/expected", positions.size()), wanted_(space, "cloth_contact/wanted"),
      near_(space, triangles, positions, rigid_bodies_of(cloths)),
      exempt_(space, exempt_pairs(positions, altitude)),
      free_step_(space, near_, exempt_, rules().collision_free_step().gap(), positions.size()),
      pressing_(space, "cloth_contact/pressing"), marks_(space, "cloth_contact/marks"),
      indices_(space, "cloth_contact/indices"), count_(space, "cloth_contact/count", 1), sum_(space),
      scratch_(space, "cloth_contact/scratch"),
      limiter_(build_surface_edges(triangles, positions.size()),
               {rules().collision_free_step().gap(), rules().collision_free_step().max_deflection},
               rules().bodies()),
      host_base_(space, "cloth_contact/host_base", positions.size()),
      host_wanted_(space, "cloth_contact/host_wanted", positions.size())
{
    half_thickness_.upload(rules().thickness().half);
    forget();
}

void DeviceClothContact::set_crossing(View<const unsigned char> crosses) { exempt_.set_crossing(crosses); }

void DeviceClothContact::forget()
{
    deviation_.fill_zero();
    slack_.upload(std::vector<double>(slack_.size(), rules().slack().min));
}

void DeviceClothContact::begin_step(const StepStart& start, NearbyBodies&)
{
    TOILE_ASSERT(start.device.x.size() == slack_.size());
    near_.abandon(); // of a step that an error has aborted
    fixed_ = start.fixed;
    prediction_ = start.device.prediction;
    parallel_for(space_, "collision/expect", start.device.x.size(),
                 ExpectMotion{start.device.x, prediction_, deviation_.view(), motion_.view()});
    begin_search(start.device.x);
}

void DeviceClothContact::begin_search(View<const Vec3> x)
{
    const StageScope stage("collision/near_pairs");
    has_base_ = false;
    parallel_for(space_, "collision/keep_base", x.size(), CopyPositions{x, base_.view()});
    parallel_for(space_, "collision/expect", x.size(),
                 ExpectEnd{base_.view(), motion_.view(), expected_.view()});
    near_.begin(base_.view(), {motion_.view(), slack_.view()}, rules().thickest());
}

void DeviceClothContact::end_search()
{
    const StageScope stage("collision/near_pairs");
    free_step_.begin(base_.view(), expected_.view(), slack_.view(), near_.end());
    list_pressing();
}

FindPressing DeviceClothContact::find_pressing() const
{
    return {near_.soup(),     base_.view(),  motion_.view(),
            expected_.view(), slack_.view(), {half_thickness_.view()}};
}

/// Lists the pairs that may press. Waits for their number.
void DeviceClothContact::list_pressing()
{
    const StageScope stage("collision/cloth_terms");
    const View<const NearPair> pairs = free_step_.pairs();
    marks_.resize(pairs.size());
    parallel_for(space_, "collision/device_mark_pressing", pairs.size(),
                 MarkPressing{find_pressing(), pairs, marks_.view()});
    pressing_.resize(
        list_flagged(space_, "collision/device_list_pressing", marks_.view(), indices_, count_, scratch_));
    parallel_for(space_, "collision/device_report_pressing", pressing_.size(),
                 ReportPressing{find_pressing(), pairs, indices_.view(), pressing_.view()});
}

void DeviceClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const size_t before = out.size();
    out.resize(before + pressing_.size());
    pressing_.download({out.data() + before, pressing_.size()});
}

bool DeviceClothContact::advance(StepField x, const FindSupported& find_supported)
{
    const double correction = limit(x, find_supported);
    if (correction <= rules().ignored_correction() && !has_slid(x.device()))
        return false;
    search_from(x.device(), correction > 0.0, true);
    return true;
}

bool DeviceClothContact::limit_motion(StepField x, StepField v, double dt,
                                      const FindSupported& find_supported)
{
    const double correction = limit(x, find_supported);
    if (correction > 0.0) {
        const View<const Vec3> reached = x.host();
        const View<Vec3> velocity = v.change_on_host();
        for (const int i : limiter_.moved())
            velocity[i] += (reached[i] - host_wanted_[i]) / dt;
    }
    if (correction <= rules().ignored_correction())
        return false;
    search_from(x.device(), true, false);
    return true;
}

/// See CollisionFreeStep::limit. If that changes x, host_wanted_ has the former x.
double DeviceClothContact::limit(StepField x, const FindSupported& find_supported)
{
    const StageScope stage("collision/collision_free_step");
    const View<const BlockedPair> blocked = free_step_.query_all(x.device());
    if (blocked.empty())
        return 0.0;
    if (!has_base_)
        copy_base();
    const View<const Vec3> wanted = x.host();
    std::copy(wanted.begin(), wanted.end(), host_wanted_.view().begin());
    const std::vector<unsigned char> supported = find_supported();
    return limiter_.limit(x.change_on_host(), supported, free_step_, blocked);
}

void DeviceClothContact::copy_base()
{
    const StageScope stage("collision/collision_free_step_to_host");
    base_.download(host_base_.view());
    space_.synchronise();
    limiter_.begin(host_base_.view(), fixed_);
    has_base_ = true;
}

/// @param was_limited  host_wanted_ has the requested positions
void DeviceClothContact::search_from(View<const Vec3> x, bool was_limited, bool goes_on)
{
    if (was_limited)
        wanted_.upload(host_wanted_.view());
    parallel_for(space_, "collision/expect_remaining", x.size(),
                 ExpectRemaining{x, was_limited ? View<const Vec3>(wanted_.view()) : x, goes_on,
                                 rules().slack(), motion_.view(), slack_.view()});
    begin_search(x);
    end_search();
}

bool DeviceClothContact::has_slid(View<const Vec3> x)
{
    const View<const NearPair> pairs = free_step_.pairs();
    return parallel_sum(
               space_, "collision/device_slid", pairs.size(), 0,
               CountSlid{near_.soup(), pairs, x, expected_.view(), {half_thickness_.view()}, rules().slid()},
               sum_) > 0;
}

void DeviceClothContact::end_step(StepField x)
{
    parallel_for(space_, "collision/update_deviation", x.size(),
                 UpdateDeviation{x.device(), prediction_, rules().learned_slack(is_clear()),
                                 deviation_.view(), slack_.view()});
}

} // namespace toile::collision
