#include "collision/contact/cpu/cloth_contact.h"

#include <algorithm>
#include <limits>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

CollisionFreeStep::Settings with_bodies(CollisionFreeStep::Settings settings, int first_prescribed)
{
    settings.first_prescribed = first_prescribed;
    return settings;
}

/// Altitudes for ExemptPairs: slivers of bodies are no matter of cloth.
std::vector<double> with_bodies(View<const double> altitude, size_t vertices)
{
    std::vector<double> all(altitude.begin(), altitude.end());
    all.resize(vertices, std::numeric_limits<double>::max());
    return all;
}

} // namespace

HostClothContact::Soup::Soup(View<const Triangle> cloth, View<const Vec3> start,
                             const std::vector<ContactCloth>& cloths, const BodySurfaces& bodies,
                             bool cloth_with_cloth)
    : triangles(cloth.begin(), cloth.end()), positions(start.begin(), start.end()),
      rigid(rigid_bodies_of(cloths))
{
    const int count = start.size();
    for (const Triangle& t : bodies.triangles())
        triangles.push_back(t + Triangle::Constant(count));
    positions.resize(count + bodies.vertex_count());
    bodies.pose_t1(View<Vec3>(positions).subview(count, bodies.vertex_count()));
    if (!cloth_with_cloth)
        rigid.assign(count, kTogether);
    else if (rigid.empty() && !bodies.is_empty())
        rigid.assign(count, -1);
    if (!rigid.empty())
        rigid.resize(positions.size(), kPrescribed);
}

HostClothContact::HostClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                                   const std::vector<ContactCloth>& cloths, View<const double> altitude,
                                   BodySurfaces bodies, bool cloth_with_cloth)
    : HostClothContact(Soup(triangles, positions, cloths, bodies, cloth_with_cloth), triangles, positions,
                       cloths, altitude, std::move(bodies))
{
}

HostClothContact::HostClothContact(const Soup& soup, View<const Triangle> triangles,
                                   View<const Vec3> positions, const std::vector<ContactCloth>& cloths,
                                   View<const double> altitude, BodySurfaces&& bodies)
    : ClothContact({triangles, positions, cloths, altitude, bodies.are_open()}), count_(positions.size()),
      bodies_(std::move(bodies)), let_through_(bodies_, triangles, count_),
      near_(soup.triangles, soup.positions, soup.rigid),
      exempt_(soup.positions, with_bodies(altitude, soup.positions.size()),
              CollisionFreeStep::Settings{}.min_gap),
      free_step_(near_, exempt_, with_bodies(rules().collision_free_step(), count_), rules().bodies()),
      carry_(near_, exempt_, rules().collision_free_step(), rules().bodies(), count_),
      slack_(soup.positions.size(), rules().slack().min), fixed_(soup.positions.size(), 1),
      deviation_(count_, Vec3::Zero()), body_motion_(bodies_.vertex_count(), Vec3::Zero()),
      base_(soup.positions), motion_(base_.size(), Vec3::Zero()), expected_(base_.size()), end_(base_.size())
{
}

void HostClothContact::begin_step(const StepStart& start, NearbyBodies& near)
{
    std::copy(start.fixed.begin(), start.fixed.end(), fixed_.begin());
    prediction_ = start.prediction;
    std::copy(start.x.begin(), start.x.end(), base_.begin());
    if (!bodies_.is_empty())
        let_through_.begin_step(start.x, near.nearest());
    show_let_through();
    is_carried_ = bodies_.is_moving();
    if (is_carried_)
        carry(near.advect(start));
    else
        stand();
    parallel_for(kCpu, "collision/expect", count_,
                 ExpectMotion{base_, prediction_, deviation_, View<Vec3>(motion_)});
    std::fill(motion_.begin() + count_, motion_.end(), Vec3::Zero());
    search();
}

/// Puts bodies that do not move into base_.
void HostClothContact::stand()
{
    carry_.forget();
    bodies_.pose_t1(bodies_of(base_));
    std::fill(body_motion_.begin(), body_motion_.end(), Vec3::Zero());
}

/// Moves base_ from t0 to where the bodies have arrived. Prescribed vertices of cloth go to their targets.
void HostClothContact::carry(View<const Vec3> advected)
{
    std::vector<Vec3> way(count_), end(bodies_.vertex_count());
    for (int v = 0; v < count_; ++v)
        way[v] = rules().bodies().is_rigid(v)
                     ? Vec3(Vec3::Zero())
                     : Vec3((fixed_[v] != 0 ? prediction_[v] : advected[v]) - base_[v]);
    bodies_.pose_t0(bodies_of(base_));
    bodies_.pose_t1(end);
    for (size_t b = 0; b < end.size(); ++b)
        body_motion_[b] = end[b] - base_[count_ + b];
    carry_.carry(base_, way, end, slack_, fixed_,
                 [this](View<const BlockedPair> blocked) { return release(blocked); });
    std::vector<ExemptPairs::BodyCrossing> crossings;
    for (const CarriedStart::StuckPair& stuck : carry_.stuck())
        for (const int v : stuck)
            for (const int w : stuck)
                if (v < count_ && w >= count_)
                    crossings.emplace_back(v, w);
    if (!crossings.empty())
        exempt_.add_body_crossings(crossings);
}

void HostClothContact::show_let_through()
{
    if (let_through_.any())
        exempt_.set_let_through(let_through_.released(), let_through_.owner_normal(),
                                let_through_.body_normal());
    else
        exempt_.set_let_through({}, {}, {});
}

/// Lets bodies through the cloth of blocked pairs. False if that changes nothing.
bool HostClothContact::release(View<const BlockedPair> blocked)
{
    std::vector<int> vertices;
    for (const BlockedPair& pair : blocked)
        if (is_with_body(pair.pair, count_))
            std::copy_if(pair.pair.vertex.begin(), pair.pair.vertex.end(), std::back_inserter(vertices),
                         [&](int v) { return v < count_; });
    const bool has_released = let_through_.release(vertices);
    show_let_through();
    return has_released;
}

void HostClothContact::set_crossing(View<const unsigned char> crosses)
{
    std::vector<unsigned char> all(crosses.begin(), crosses.end());
    all.resize(base_.size(), 0);
    exempt_.set_crossing(all);
}

/// Numbers the vertices of bodies after those of cloth.
void HostClothContact::set_body_crossings(View<const std::pair<int, int>> crossings,
                                          View<const unsigned char> inside)
{
    exempt_.set_inside(inside);
    std::vector<ExemptPairs::BodyCrossing> all(crossings.begin(), crossings.end());
    for (auto& [cloth, body] : all)
        body += count_;
    exempt_.set_body_crossings(std::move(all));
}

int HostClothContact::first_stuck() const
{
    const CarriedStart::StuckPair& pair = carry_.stuck().front();
    return *std::find_if(pair.begin(), pair.end(), [&](int v) { return v < count_; });
}

bool HostClothContact::replaces(const ContactPair& pair) const
{
    if (bodies_.is_empty())
        return false;
    if (pair.kind < ContactKind::kGuard && bodies_.is_open(pair.collider) && pair.gap(base_) < 0.0)
        return true; // it stays behind: a guard keeps it there
    if (!let_through_.any() || pair.is_between_cloths())
        return false;
    for (int k = 0; k < pair.count(); ++k)
        if (let_through_.lets_pass(pair.vertex[k], pair.normal))
            return true;
    return false;
}

/// Finds the pairs of trajectories from base_ that motion_ expects.
void HostClothContact::search()
{
    const StageScope stage("collision/near_pairs");
    near_.find(base_, {motion_, slack_}, rules().thickest(), pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt_.is_exempt(pair); });
    between_cloths_ =
        int(std::stable_partition(pairs_.begin(), pairs_.end(),
                                  [&](const NearPair& pair) { return !is_with_body(pair, count_); }) -
            pairs_.begin());
    parallel_for(kCpu, "collision/expect", int(base_.size()), ExpectEnd{base_, motion_, expected_});
    free_step_.begin(base_, expected_, slack_, fixed_, pairs_);
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
                    found.push_back(i < between_cloths_ ? pair : guard_of(pair, pairs_[i]));
        },
        out);
}

/// Guard of a pair with a body.
ContactPair HostClothContact::guard_of(const ContactPair& pair, const NearPair& near) const
{
    ContactPair guard;
    guard.kind = ContactKind::kGuard;
    guard.weight = {};
    const double side = pair.vertex[0] < count_ ? 1.0 : -1.0;
    guard.normal = side * pair.normal;
    guard.feature = pair.vertex[0] < count_ ? near.second : near.first;
    int used = 0;
    for (int k = 0; k < 4; ++k) {
        const int v = pair.vertex[k];
        const double weight = side * pair.weight[k];
        if (v < count_) {
            guard.vertex[used] = v;
            guard.weight[used++] = weight;
        } else {
            guard.point -= weight * base_[v];
            guard.motion -= weight * body_motion_[v - count_];
            guard.collider = bodies_.collider_of(v - count_);
        }
    }
    if (bodies_.is_open(guard.collider)) {
        Vec3 outwards = Vec3::Zero();
        for (const int v : pair.vertex)
            if (v >= count_)
                outwards += let_through_.body_normal()[v - count_];
        if (outwards.dot(guard.normal) < 0.0)
            guard.kind = ContactKind::kTwoSided;
    }
    return guard;
}

/// Limits x [cloth] [m]; end_ and wanted_ are the results and what was asked for. Returns the correction [m].
double HostClothContact::limit(View<Vec3> x, const FindSupported& find_supported)
{
    std::copy(x.begin(), x.end(), end_.begin());
    std::copy(base_.begin() + count_, base_.end(), end_.begin() + count_);
    wanted_ = end_;
    std::vector<unsigned char> supported = find_supported();
    supported.resize(end_.size(), 0);
    const double correction = free_step_.limit(end_, supported);
    if (correction > 0.0)
        std::copy_n(end_.begin(), count_, x.begin());
    return correction;
}

bool HostClothContact::advance(StepField positions, const FindSupported& find_supported)
{
    const double correction = limit(positions.change_on_host(), find_supported);
    if (correction <= rules().ignored_correction() && !has_slid())
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
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), rules().slack().min);
    let_through_.forget();
    carry_.forget();
}

} // namespace toile::collision
