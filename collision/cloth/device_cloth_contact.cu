#include "collision/cloth/device_cloth_contact.h"

#include <algorithm>

#include "collision/surface_edges.h"
#include "core/backend/cuda/parallel.cuh"
#include "core/pd/device/body_kernels.h"

namespace toile {

namespace {

ExemptPairs exempt_pairs(View<const Vec3> positions, View<const double> altitude)
{
    return {positions, altitude, SafeStep::Settings{}.least_gap};
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
      safe_(space, near_, exempt_, rules().safe_step().gap(), positions.size()),
      pressing_(space, "cloth_contact/pressing"), marks_(space, "cloth_contact/marks"),
      places_(space, "cloth_contact/places"), count_(space, "cloth_contact/count", 1), sum_(space),
      scratch_(space, "cloth_contact/scratch"),
      bring_back_(build_surface_edges(triangles, positions.size()),
                  {rules().safe_step().gap(), rules().safe_step().most_deflection}, rules().bodies()),
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
    slack_.upload(std::vector<double>(slack_.size(), rules().slack().least));
}

void DeviceClothContact::begin_step(const StepStart& start)
{
    TOILE_ASSERT(start.there.x.size() == slack_.size());
    near_.abandon(); // of a step that an error has ended
    fixed_ = start.fixed;
    prediction_ = start.there.prediction;
    parallel_for(space_, "collision/expect", start.there.x.size(),
                 ExpectMotion{start.there.x, prediction_, deviation_.view(), motion_.view()});
    begin_search(start.there.x);
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
    safe_.begin(base_.view(), expected_.view(), slack_.view(), near_.end());
    list_pressing();
}

FindPressing DeviceClothContact::find_pressing() const
{
    return {near_.soup(),     base_.view(),  motion_.view(),
            expected_.view(), slack_.view(), {half_thickness_.view()}};
}

/// Waits for their number.
void DeviceClothContact::list_pressing()
{
    const StageScope stage("collision/cloth_terms");
    const View<const NearPair> pairs = safe_.pairs();
    marks_.resize(pairs.size());
    parallel_for(space_, "collision/device_mark_pressing", pairs.size(),
                 MarkPressing{find_pressing(), pairs, marks_.view()});
    pressing_.resize(
        list_flagged(space_, "collision/device_list_pressing", marks_.view(), places_, count_, scratch_));
    parallel_for(space_, "collision/device_report_pressing", pressing_.size(),
                 ReportPressing{find_pressing(), pairs, places_.view(), pressing_.view()});
}

void DeviceClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const size_t before = out.size();
    out.resize(before + pressing_.size());
    pressing_.download({out.data() + before, pressing_.size()});
}

bool DeviceClothContact::advance(StepField x, const Leaning& leans)
{
    const double held = limit(x, leans);
    if (held <= rules().held_aside() && !has_slid(x.there()))
        return false;
    look_on(x.there(), held > 0.0, true);
    return true;
}

bool DeviceClothContact::hold_back(StepField x, StepField v, double dt, const Leaning& leans)
{
    const double held = limit(x, leans);
    if (held > 0.0) {
        const View<const Vec3> reached = x.host();
        const View<Vec3> velocity = v.change_on_host();
        for (const int i : bring_back_.moved())
            velocity[i] += (reached[i] - host_wanted_[i]) / dt;
    }
    if (held <= rules().held_aside())
        return false;
    look_on(x.there(), true, false);
    return true;
}

/// As SafeStep::limit. Where that changes x, host_wanted_ has what it was.
double DeviceClothContact::limit(StepField x, const Leaning& leans)
{
    const StageScope stage("collision/safe_step");
    const View<const BlockedPair> in_the_way = safe_.look_at_all(x.there());
    if (in_the_way.empty())
        return 0.0;
    if (!has_base_)
        copy_base();
    const View<const Vec3> wanted = x.host();
    std::copy(wanted.begin(), wanted.end(), host_wanted_.view().begin());
    const std::vector<unsigned char> leaning = leans();
    return bring_back_.limit(x.change_on_host(), leaning, safe_, in_the_way);
}

void DeviceClothContact::copy_base()
{
    const StageScope stage("collision/safe_step_to_host");
    base_.download(host_base_.view());
    space_.synchronise();
    bring_back_.begin(host_base_.view(), fixed_);
    has_base_ = true;
}

/// @param was_held  host_wanted_ is where the cloth wanted to be
void DeviceClothContact::look_on(View<const Vec3> x, bool was_held, bool goes_on)
{
    if (was_held)
        wanted_.upload(host_wanted_.view());
    parallel_for(space_, "collision/look_on", x.size(),
                 LookOn{x, was_held ? View<const Vec3>(wanted_.view()) : x, goes_on, rules().slack(),
                        motion_.view(), slack_.view()});
    begin_search(x);
    end_search();
}

bool DeviceClothContact::has_slid(View<const Vec3> x)
{
    const View<const NearPair> pairs = safe_.pairs();
    return parallel_sum(
               space_, "collision/device_slid", pairs.size(), 0,
               CountSlid{near_.soup(), pairs, x, expected_.view(), {half_thickness_.view()}, rules().slid()},
               sum_) > 0;
}

void DeviceClothContact::end_step(StepField x)
{
    parallel_for(space_, "collision/learn_deviation", x.size(),
                 LearnDeviation{x.there(), prediction_, rules().slack(), deviation_.view(), slack_.view()});
}

} // namespace toile
