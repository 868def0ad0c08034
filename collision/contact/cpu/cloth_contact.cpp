#include "collision/contact/cpu/cloth_contact.h"

#include <algorithm>

#include "core/compute/parallel.h"

namespace toile::collision {

HostClothContact::HostClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                                   const std::vector<ContactCloth>& cloths, View<const double> altitude)
    : ClothContact({triangles, positions, cloths, altitude}),
      near_(triangles, positions, rigid_bodies_of(cloths)),
      exempt_(positions, altitude, CollisionFreeStep::Settings{}.min_gap),
      free_step_(near_, exempt_, rules().collision_free_step(), rules().bodies()),
      slack_(positions.size(), rules().slack().min), deviation_(positions.size(), Vec3::Zero()),
      motion_(positions.size()), expected_(positions.size())
{
}

void HostClothContact::begin_step(const StepStart& start)
{
    fixed_ = start.fixed;
    prediction_ = start.prediction;
    parallel_for(kCpu, "collision/expect", start.x.size(),
                 ExpectMotion{start.x, prediction_, deviation_, motion_});
    search(start.x);
}

void HostClothContact::search(View<const Vec3> x)
{
    const StageScope stage("collision/near_pairs");
    near_.find(x, {motion_, slack_}, rules().thickest(), pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt_.is_exempt(pair); });
    parallel_for(kCpu, "collision/expect", x.size(), ExpectEnd{x, motion_, expected_});
    free_step_.begin(x, expected_, slack_, fixed_, pairs_);
}

void HostClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const FindPressing find{near_.soup(), free_step_.base(), motion_, expected_, slack_, rules().thickness()};
    parallel_append(
        kCpu, "collision/cloth_terms", int(pairs_.size()),
        [&](int begin, int end, std::vector<ContactPair>& found) {
            ContactPair pair;
            for (int i = begin; i < end; ++i)
                if (find(pairs_[i], pair))
                    found.push_back(pair);
        },
        out);
}

bool HostClothContact::advance(StepField positions, const FindSupported& find_supported)
{
    const View<Vec3> x = positions.change_on_host();
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double correction = free_step_.limit(x, find_supported());
    if (correction <= rules().ignored_correction() && !has_slid(x))
        return false;
    search_from(x, wanted, true);
    return true;
}

bool HostClothContact::limit_motion(StepField positions, StepField velocities, double dt,
                                    const FindSupported& find_supported)
{
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double correction = free_step_.limit(x, find_supported());
    for (int i = 0; i < x.size(); ++i)
        v[i] += (x[i] - wanted[i]) / dt;
    if (correction <= rules().ignored_correction())
        return false;
    search_from(x, wanted, false);
    return true;
}

void HostClothContact::search_from(View<const Vec3> x, View<const Vec3> wanted, bool goes_on)
{
    parallel_for(kCpu, "collision/expect_remaining", x.size(),
                 ExpectRemaining{x, wanted, goes_on, rules().slack(), motion_, slack_});
    search(x);
}

bool HostClothContact::has_slid(View<const Vec3> x) const
{
    const CountSlid slid{near_.soup(), pairs_, x, expected_, rules().thickness(), rules().slid()};
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
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), rules().slack().min);
}

} // namespace toile::collision
