#include "collision/contact/cpu/cloth_contact.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

HostClothContact::HostClothContact(ContactSoup given)
    : ClothContact(std::move(given)), slack_(soup().positions.size(), rules().slack().min),
      near_(soup().triangles, soup().positions, soup().rigid),
      free_step_(near_, exempt(), rules().collision_free_step(), rules().bodies()),
      ccd_search_(near_, exempt(), rules().collision_free_step().gap(), slack_),
      carry_(ccd_search_, near_.edges(), rules().collision_free_step(), rules().bodies()),
      deviation_(soup().first_body, Vec3::Zero()), base_(soup().positions),
      motion_(base_.size(), Vec3::Zero()), expected_(base_.size()), end_(base_.size())
{
}

void HostClothContact::begin_step(const StepStart& start, NearbyBodies& near)
{
    begin(start.fixed);
    slack_of_start_ = slack_;
    prediction_ = start.prediction;
    std::copy(start.x.begin(), start.x.end(), base_.begin());
    if (bodies().needs_begin())
        bodies().begin_step(start, near, carry_, fixed(), base_);
    parallel_for(kCpu, "collision/expect", soup().first_body,
                 ExpectMotion{base_, prediction_, deviation_, View<Vec3>(motion_)});
    search();
}

View<const Vec3> HostClothContact::carried() const
{
    return bodies().have_carried() ? soup().of_cloth(View<const Vec3>(base_)) : View<const Vec3>();
}

ReplacedPairs HostClothContact::replaced() const
{
    const ExemptRule rule = exempt().rule();
    return {base_, soup().bodies.open_colliders(), rule.lets_through, rule.owner_normal};
}

/// Finds the pairs of trajectories from base_ that motion_ expects.
void HostClothContact::search()
{
    const StageScope stage("collision/near_pairs");
    near_.find(base_, {motion_, slack_}, rules().thickest(), pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt().is_exempt(pair); });
    parallel_for(kCpu, "collision/expect", int(base_.size()), ExpectEnd{base_, motion_, expected_});
    free_step_.begin(base_, expected_, slack_, fixed(), pairs_);
}

void HostClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const FindPressing find{near_.soup(), free_step_.base(),   motion_,  expected_,
                            slack_,       rules().thickness(), stopped()};
    const GuardOf guard_of = bodies().guards(base_);
    parallel_append(
        kCpu, "collision/cloth_terms", int(pairs_.size()),
        [&](int begin, int end, std::vector<ContactPair>& found) {
            ContactPair pair;
            for (int i = begin; i < end; ++i)
                if (find(pairs_[i], pair))
                    found.push_back(guard_of.is_of(pairs_[i]) ? guard_of(pair, pairs_[i]) : pair);
        },
        out);
}

/// Limits x [cloth] [m]; end_ and wanted_ are the results and what was asked for. Returns the correction [m].
double HostClothContact::limit(View<Vec3> x, const FindSupported& find_supported)
{
    std::copy(x.begin(), x.end(), end_.begin());
    std::copy(base_.begin() + x.size(), base_.end(), end_.begin() + x.size());
    wanted_ = end_;
    std::vector<unsigned char> supported = find_supported();
    supported.resize(end_.size(), 0);
    const double correction = free_step_.limit(end_, supported);
    mark_stopped(free_step_.blocked());
    if (correction > 0.0)
        std::copy_n(end_.begin(), x.size(), x.begin());
    return correction;
}

bool HostClothContact::advance(StepField positions, const FindSupported& find_supported)
{
    const double correction = limit(positions.change_on_host(), find_supported);
    if (correction <= rules().ignored_correction() && !stops_more() && !has_slid())
        return false;
    search_from_end(true);
    return true;
}

bool HostClothContact::limit_motion(StepField positions, StepField velocities, double dt,
                                    const FindSupported& find_supported)
{
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    const double correction = limit(x, find_supported);
    for (int i = 0; i < x.size(); ++i)
        v[i] += (x[i] - wanted_[i]) / dt;
    if (correction <= rules().ignored_correction())
        return false;
    search_from_end(false);
    return true;
}

/// Begins anew from where the last limit() has ended.
void HostClothContact::search_from_end(bool goes_on)
{
    base_ = end_;
    parallel_for(kCpu, "collision/expect_remaining", int(base_.size()),
                 ExpectRemaining{base_, wanted_, goes_on, rules().slack(), motion_, slack_});
    search();
}

bool HostClothContact::has_slid() const
{
    const CountSlid slid{near_.soup(), pairs_, end_, expected_, rules().thickness(), rules().slid()};
    for (int i = 0; i < int(pairs_.size()); ++i)
        if (slid(i) != 0)
            return true;
    return false;
}

void HostClothContact::end_step(StepField positions)
{
    const View<const Vec3> x = positions.host();
    parallel_for(kCpu, "collision/update_deviation", x.size(),
                 UpdateDeviation{x, prediction_, rules().learned_slack(is_clear()), deviation_, slack_});
}

void HostClothContact::forget()
{
    ClothContact::forget();
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), rules().slack().min);
}

} // namespace toile::collision
