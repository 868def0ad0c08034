#include "collision/cloth/host_cloth_contact.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

HostClothContact::HostClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                                   const std::vector<ContactCloth>& cloths, View<const double> altitude)
    : ClothContact({triangles, positions, cloths, altitude}),
      near_(triangles, positions, rigid_bodies_of(cloths)),
      exempt_(positions, altitude, SafeStep::Settings{}.least_gap),
      safe_(near_, exempt_, rules().safe_step(), rules().bodies()),
      slack_(positions.size(), rules().slack().least), deviation_(positions.size(), Vec3::Zero()),
      motion_(positions.size()), expected_(positions.size())
{
}

void HostClothContact::begin_step(const StepStart& start)
{
    fixed_ = start.fixed;
    prediction_ = start.prediction;
    parallel_for(kCpu, "collision/expect", start.x.size(),
                 ExpectMotion{start.x, prediction_, deviation_, motion_});
    look(start.x);
}

void HostClothContact::look(View<const Vec3> x)
{
    const StageScope stage("collision/near_pairs");
    near_.find(x, {motion_, slack_}, rules().thickest(), pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt_.is_exempt(pair); });
    parallel_for(kCpu, "collision/expect", x.size(), ExpectEnd{x, motion_, expected_});
    safe_.begin(x, expected_, slack_, fixed_, pairs_);
}

void HostClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    const FindPressing find{near_.soup(), safe_.base(), motion_, expected_, slack_, rules().thickness()};
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

bool HostClothContact::advance(StepField positions, const Leaning& leans)
{
    const View<Vec3> x = positions.change_on_host();
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double held = safe_.limit(x, leans());
    if (held <= rules().held_aside() && !has_slid(x))
        return false;
    look_on(x, wanted, true);
    return true;
}

bool HostClothContact::hold_back(StepField positions, StepField velocities, double dt, const Leaning& leans)
{
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double held = safe_.limit(x, leans());
    for (int i = 0; i < x.size(); ++i)
        v[i] += (x[i] - wanted[i]) / dt;
    if (held <= rules().held_aside())
        return false;
    look_on(x, wanted, false);
    return true;
}

void HostClothContact::look_on(View<const Vec3> x, View<const Vec3> wanted, bool goes_on)
{
    parallel_for(kCpu, "collision/look_on", x.size(),
                 LookOn{x, wanted, goes_on, rules().slack(), motion_, slack_});
    look(x);
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
    parallel_for(kCpu, "collision/learn_deviation", x.size(),
                 LearnDeviation{x, prediction_, rules().slack(), deviation_, slack_});
}

void HostClothContact::forget()
{
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), rules().slack().least);
}

} // namespace toile
