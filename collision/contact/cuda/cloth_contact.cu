#include "collision/contact/cuda/cloth_contact.h"

#include <algorithm>

#include "collision/geometry/surface_edges.h"
#include "core/compute/copy_items.h"
#include "core/compute/cuda/parallel.cuh"
#include "core/pd/cuda/body_kernels.h"

namespace toile::collision {

DeviceClothContact::DeviceClothContact(const CudaSpace& space, ContactSoup soup)
    : DeviceClothContact(space, soup, build_surface_edges(soup.triangles, soup.vertex_count()))
{
}

DeviceClothContact::DeviceClothContact(const CudaSpace& space, ContactSoup given, const SurfaceEdges& edges)
    : ClothContact(std::move(given)), space_(space), half_thickness_(space, "cloth_contact/half_thickness"),
      slack_(space, "cloth_contact/slack", soup().vertex_count()),
      slack_of_start_(space, "cloth_contact/slack_of_start", soup().vertex_count()),
      deviation_(space, "cloth_contact/deviation", soup().first_body), base_(space, "cloth_contact/base"),
      motion_(space, "cloth_contact/motion", soup().vertex_count()),
      expected_(space, "cloth_contact/expected", soup().vertex_count()), end_(space, "cloth_contact/end"),
      wanted_(space, "cloth_contact/wanted"), body_motion_(space, "cloth_contact/body_motion"),
      outward_(space, "cloth_contact/outward"), collider_(space, "cloth_contact/collider"),
      is_open_(space, "cloth_contact/is_open"), open_colliders_(space, "cloth_contact/open_colliders"),
      near_(space, soup().triangles, soup().positions, soup().rigid), exempt_(space, exempt()),
      free_step_(space, near_, exempt_, rules().collision_free_step().gap(), soup().vertex_count()),
      pressing_(space, "cloth_contact/pressing"), marks_(space, "cloth_contact/marks"),
      stopped_on_device_(space, "cloth_contact/stopped"), indices_(space, "cloth_contact/indices"),
      count_(space, "cloth_contact/count", 1), sum_(space), scratch_(space, "cloth_contact/scratch"),
      ccd_search_(space, near_, free_step_, rules().collision_free_step().gap(), slack_),
      carry_(ccd_search_, edges, rules().collision_free_step(), rules().bodies()),
      limiter_(edges,
               {rules().collision_free_step().gap(), rules().collision_free_step().max_deflection,
                soup().first_body},
               rules().bodies()),
      host_base_(space, "cloth_contact/host_base", soup().vertex_count()),
      host_wanted_(space, "cloth_contact/host_wanted", soup().vertex_count()),
      host_prediction_(space, "cloth_contact/host_prediction", soup().has_bodies() ? soup().first_body : 0)
{
    half_thickness_.upload(rules().thickness().half);
    base_.upload(soup().positions);
    end_.upload(soup().positions);
    motion_.fill_zero();
    const GuardOf guards = bodies().guards({});
    body_motion_.upload(guards.motion);
    collider_.upload(guards.collider);
    is_open_.upload(guards.is_open);
    if (soup().has_bodies())
        open_colliders_.upload(soup().bodies.open_colliders());
    forget();
}

void DeviceClothContact::forget()
{
    ClothContact::forget();
    forget_motion();
}

/// Forgets how far vertices end from where they were expected.
void DeviceClothContact::forget_motion()
{
    deviation_.fill_zero();
    slack_.upload(std::vector<double>(slack_.size(), rules().slack().min));
}

void DeviceClothContact::begin_step(const StepStart& start, NearbyBodies& near)
{
    const int cloth = soup().first_body;
    TOILE_ASSERT(start.device.x.size() == cloth);
    near_.abandon(); // of a step that an error has aborted
    begin(start.fixed);
    parallel_for(space_, "collision/keep_slack", slack_.size(),
                 CopyItems<double>{slack_.view(), slack_of_start_.view()});
    prediction_ = start.device.prediction;
    parallel_for(space_, "collision/keep_base", cloth,
                 CopyItems<Vec3>{start.device.x, soup().of_cloth(base_.view())});
    if (bodies().needs_begin())
        begin_bodies(start, near);
    parallel_for(space_, "collision/expect", cloth,
                 ExpectMotion{base_.view(), prediction_, deviation_.view(), motion_.view()});
    begin_search();
}

/// Begins a step in which bodies do not just stand. The host has their surfaces and decides who goes along.
void DeviceClothContact::begin_bodies(const StepStart& start, NearbyBodies& near)
{
    const StageScope stage("collision/bodies_on_host");
    const View<Vec3> base = host_base_.view();
    base_.download(base);
    parallel_for(space_, "collision/keep_prediction", prediction_.size(),
                 CopyItems<Vec3>{prediction_, soup().of_cloth(expected_.view())});
    expected_.download_first(host_prediction_.view());
    space_.synchronise();
    StepStart on_host = start;
    on_host.x = soup().of_cloth(base);
    on_host.prediction = host_prediction_.view();
    near_.set_limited(false); // bodies arrive on time, whatever they sweep through
    bodies().begin_step(on_host, near, carry_, fixed(), base);
    near_.set_limited(true);
    base_.upload(base);
    end_.upload(base);
    const GuardOf guards = bodies().guards(base);
    body_motion_.upload(guards.motion);
    outward_.upload(guards.outward);
}

View<const Vec3> DeviceClothContact::carried() const
{
    return bodies().have_carried() ? soup().of_cloth(base_.view()) : View<const Vec3>();
}

ReplacedPairs DeviceClothContact::replaced() const
{
    const ExemptRule rule = exempt_.rule();
    return {base_.view(), open_colliders_.view(), rule.lets_through, rule.owner_normal};
}

/// Finds the pairs of trajectories from base_ that motion_ expects.
void DeviceClothContact::begin_search()
{
    const StageScope stage("collision/near_pairs");
    has_base_ = false;
    parallel_for(space_, "collision/expect", base_.size(),
                 ExpectEnd{base_.view(), motion_.view(), expected_.view()});
    near_.begin(base_.view(), {motion_.view(), slack_.view()}, rules().thickest());
}

void DeviceClothContact::end_search()
{
    const StageScope stage("collision/near_pairs");
    free_step_.begin(base_.view(), expected_.view(), slack_.view(), found_pairs());
    list_pressing();
}

/// Waits for the search. Where expected trajectories sweep through too much, it is repeated for cloth that
/// stands: limit() finds the pairs of the others.
View<const NearPair> DeviceClothContact::found_pairs()
{
    try {
        return near_.end();
    } catch (const TooManyPairs&) {
        motion_.fill_zero();
        forget_motion();
        begin_search();
        return near_.end();
    }
}

FindPressing DeviceClothContact::find_pressing() const
{
    FindPressing find{near_.soup(),     base_.view(),  motion_.view(),
                      expected_.view(), slack_.view(), {half_thickness_.view()}};
    if (!stopped().empty())
        find.stopped = stopped_on_device_.view();
    return find;
}

GuardOf DeviceClothContact::guards() const
{
    return {soup().first_body, base_.view(),    body_motion_.view(),
            collider_.view(),  is_open_.view(), outward_.view()};
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
                 ReportPressing{find_pressing(), guards(), pairs, indices_.view(), pressing_.view()});
}

void DeviceClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const size_t before = out.size();
    out.resize(before + pressing_.size());
    pressing_.download({out.data() + before, pressing_.size()});
}

/// Cloth at x [cloth], followed by the bodies, on the device [m].
View<const Vec3> DeviceClothContact::with_bodies(View<const Vec3> x)
{
    if (!soup().has_bodies())
        return x;
    parallel_for(space_, "collision/with_bodies", x.size(), CopyItems<Vec3>{x, soup().of_cloth(end_.view())});
    return end_.view();
}

bool DeviceClothContact::advance(StepField x, const FindSupported& find_supported)
{
    const double correction = limit(x, find_supported);
    const View<const Vec3> all = with_bodies(x.device());
    if (correction <= rules().ignored_correction() && !stops_more() && !has_slid(all))
        return false;
    search_from(all, correction > 0.0, true);
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
            if (i < soup().first_body)
                velocity[i] += (reached[i] - host_wanted_[i]) / dt;
        for (size_t i = 0; i < host_requested_.size(); ++i) // what was taken back, before that
            velocity[int(i)] += (host_wanted_[int(i)] - host_requested_[i]) / dt;
    }
    if (correction <= rules().ignored_correction())
        return false;
    search_from(with_bodies(x.device()), true, false);
    return true;
}

/// See CollisionFreeStep::limit. If that changes x, host_wanted_ has the x that blocked pairs were limited
/// from. Of motion that sweeps through too much, as from a minimiser that has lost its way, half is taken
/// back until its pairs are few; that of fixed vertices, which follow a target, only if this does not help.
double DeviceClothContact::limit(StepField x, const FindSupported& find_supported)
{
    constexpr int kHalvingsOfFree = 30, kMaxHalvings = 60;
    const StageScope stage("collision/collision_free_step");
    host_requested_.clear();
    double taken_back = 0.0;
    for (int halvings = 0;; ++halvings)
        try {
            return std::max(taken_back, limit_blocked(x, find_supported));
        } catch (const TooManyPairs&) {
            free_step_.forget_known();
            if (halvings == kMaxHalvings)
                throw;
            taken_back += take_half_back(x, halvings >= kHalvingsOfFree);
        }
}

/// @return the largest part of a vertex' motion [m]
double DeviceClothContact::take_half_back(StepField x, bool with_fixed)
{
    if (!has_base_)
        copy_base();
    const View<Vec3> end = x.change_on_host(), wanted = host_wanted_.view();
    const View<const Vec3> base = host_base_.view();
    if (host_requested_.empty())
        host_requested_.assign(end.begin(), end.end());
    std::copy(base.begin(), base.end(), wanted.begin());
    double largest = 0.0;
    for (int v = 0; v < end.size(); ++v) {
        if (fixed()[v] != 0 && !with_fixed) {
            wanted[v] = end[v];
            continue;
        }
        const Vec3 half = 0.5 * (end[v] - base[v]);
        largest = std::max(largest, half.norm());
        wanted[v] = end[v] = base[v] + half;
    }
    return largest;
}

double DeviceClothContact::limit_blocked(StepField x, const FindSupported& find_supported)
{
    const View<const BlockedPair> blocked = free_step_.query_all(with_bodies(x.device()));
    mark_stopped(blocked);
    if (blocked.empty())
        return 0.0;
    if (stops_more())
        stopped_on_device_.upload(stopped());
    if (!has_base_)
        copy_base();
    const View<const Vec3> wanted = x.host();
    const View<Vec3> all = host_wanted_.view(), base = host_base_.view();
    std::copy(wanted.begin(), wanted.end(), all.begin());
    std::copy(base.begin() + wanted.size(), base.end(), all.begin() + wanted.size());
    host_end_.assign(all.begin(), all.end());
    std::vector<unsigned char> supported = find_supported();
    supported.resize(host_end_.size(), 0);
    const double correction = limiter_.limit(host_end_, supported, free_step_, blocked);
    std::copy_n(host_end_.begin(), x.size(), x.change_on_host().begin());
    return correction;
}

void DeviceClothContact::copy_base()
{
    const StageScope stage("collision/collision_free_step_to_host");
    base_.download(host_base_.view());
    space_.synchronise();
    limiter_.begin(host_base_.view(), fixed());
    has_base_ = true;
}

/// @param x            [vertices] on the device [m]
/// @param was_limited  by limit(), from host_wanted_
void DeviceClothContact::search_from(View<const Vec3> x, bool was_limited, bool goes_on)
{
    if (was_limited)
        wanted_.upload(host_wanted_.view());
    parallel_for(space_, "collision/expect_remaining", x.size(),
                 ExpectRemaining{x, was_limited ? View<const Vec3>(wanted_.view()) : x, goes_on,
                                 rules().slack(), motion_.view(), slack_.view()});
    parallel_for(space_, "collision/keep_base", x.size(), CopyItems<Vec3>{x, base_.view()});
    begin_search();
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

void DeviceClothContact::abandon_step()
{
    parallel_for(space_, "collision/abandon", slack_.size(),
                 CopyItems<double>{slack_of_start_.view(), slack_.view()});
}

void DeviceClothContact::end_step(StepField x)
{
    parallel_for(space_, "collision/update_deviation", x.size(),
                 UpdateDeviation{x.device(), prediction_, rules().learned_slack(is_clear()),
                                 deviation_.view(), slack_.view()});
}

} // namespace toile::collision
