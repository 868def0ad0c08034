#include "collision/contact/contact_bodies.h"

#include <algorithm>
#include <limits>

#include "core/compute/parallel.h"

namespace toile::collision {

namespace {

/// Rings of cloth around that near a body over which its motion fades: cloth torn between both would have to
/// be brought together again.
constexpr int kFadingRings = 5;

} // namespace

ContactSoup::ContactSoup(View<const Triangle> cloth_triangles, View<const Vec3> cloth_positions,
                         const std::vector<ContactCloth>& all_cloths, View<const double> cloth_altitude,
                         BodySurfaces all_bodies, bool cloth_with_cloth)
    : cloths(all_cloths), bodies(std::move(all_bodies)), first_body(cloth_positions.size()),
      triangles(cloth_triangles.begin(), cloth_triangles.end()),
      positions(cloth_positions.begin(), cloth_positions.end()),
      altitude(cloth_altitude.begin(), cloth_altitude.end()), rigid(rigid_bodies_of(cloths))
{
    for (const Triangle& t : bodies.triangles())
        triangles.push_back(t + Triangle::Constant(first_body));
    positions.resize(first_body + bodies.vertex_count());
    bodies.pose_t1(of_bodies(View<Vec3>(positions)));
    altitude.resize(positions.size(), std::numeric_limits<double>::max());
    if (!cloth_with_cloth)
        rigid.assign(first_body, kTogether);
    else if (rigid.empty() && has_bodies())
        rigid.assign(first_body, -1);
    if (!rigid.empty())
        rigid.resize(positions.size(), kPrescribed);
}

ContactBodies::ContactBodies(ContactSoup& soup, const ClothContactRules& rules, ExemptPairs& exempt)
    : soup_(soup), rules_(rules), exempt_(exempt),
      let_through_(soup.bodies, soup.triangles_of_cloth(), soup.first_body, room_of(soup.cloths)),
      collider_(soup.bodies.colliders()), is_open_(soup.bodies.are_open()),
      motion_(soup.bodies.vertex_count(), Vec3::Zero()),
      has_open_(std::find(is_open_.begin(), is_open_.end(), 1) != is_open_.end())
{
}

bool ContactBodies::needs_begin() const
{
    return soup_.has_bodies() && (!has_begun_ || has_carried_ || surfaces().is_moving() ||
                                  surfaces().has_jumped() || let_through_.any());
}

void ContactBodies::begin_step(const StepStart& start, NearbyBodies& near, CarriedStart& carry,
                               View<const unsigned char> fixed, View<Vec3> base)
{
    has_begun_ = true;
    has_carried_ = surfaces().is_moving();
    const View<const NearestSurface> nearest = near.nearest();
    let_through_.begin_step(soup_.of_cloth(base), nearest);
    show_let_through();
    if (has_open_)
        outward_ = let_through_.body_normal();
    if (has_carried_)
        move(start, nearest, near.advect(start), carry, fixed, base);
    else
        stand(base);
}

void ContactBodies::stand(View<Vec3> base)
{
    stuck_.clear();
    surfaces().pose_t1(soup_.of_bodies(base));
    std::fill(motion_.begin(), motion_.end(), Vec3::Zero());
}

/// Moves bodies, and cloth with those near it. Prescribed vertices of cloth go to their targets.
void ContactBodies::move(const StepStart& start, View<const NearestSurface> nearest,
                         View<const Vec3> advected, CarriedStart& carry, View<const unsigned char> fixed,
                         View<Vec3> base)
{
    // Before the first search no surface is known as nearest.
    const bool is_known = std::any_of(nearest.begin(), nearest.end(),
                                      [](const NearestSurface& at) { return at.collider >= 0; });
    std::vector<Vec3> way(soup_.first_body), end(motion_.size());
    parallel_for(kCpu, "collision/expect", soup_.first_body, [&](int v) {
        way[v].setZero();
        if (rules_.bodies().is_rigid(v))
            return;
        if (fixed[v] != 0)
            way[v] = start.prediction[v] - base[v];
        else if (let_through_.goes_with_owner(v))
            way[v] = let_through_.owner_motion(v);
        else if (nearest[v].collider >= 0 || !is_known)
            way[v] = advected[v] - base[v];
    });
    fade(nearest, fixed, way);
    const View<Vec3> bodies = soup_.of_bodies(base);
    surfaces().pose_t0(bodies);
    surfaces().pose_t1(end);
    for (size_t b = 0; b < end.size(); ++b)
        motion_[b] = end[b] - bodies[int(b)];
    carry.carry(base, way, end, fixed,
                [this](View<const BlockedPair> blocked, bool is_last) { return release(blocked, is_last); });
    stuck_ = carry.stuck();
    exempt_stuck();
}

/// Lets the motion of cloth that is attached or near a body fade over the rings around it: the mean of the
/// neighbours, as often as there are rings.
void ContactBodies::fade(View<const NearestSurface> nearest, View<const unsigned char> fixed,
                         View<Vec3> way) const
{
    std::vector<unsigned char> is_known(way.size());
    std::vector<int> rings, frontier;
    for (int v = 0; v < way.size(); ++v)
        if (fixed[v] != 0 || nearest[v].collider >= 0 || let_through_.is_released(v) ||
            rules_.bodies().is_rigid(v)) {
            is_known[v] = 1;
            frontier.push_back(v);
        }
    for (int ring = 0; ring < kFadingRings; ++ring) {
        std::vector<int> next;
        for (const int v : frontier)
            for (const int n : let_through_.neighbours(v))
                if (is_known[n] == 0) {
                    is_known[n] = 1;
                    next.push_back(n);
                }
        rings.insert(rings.end(), next.begin(), next.end());
        frontier = std::move(next);
    }
    std::vector<Vec3> mean(rings.size());
    for (int sweep = 0; sweep < kFadingRings; ++sweep) {
        parallel_for(kCpu, "collision/fade", int(rings.size()), [&](int i) {
            const View<const int> around = let_through_.neighbours(rings[i]);
            mean[i].setZero();
            for (const int n : around)
                mean[i] += way[n] / around.size();
        });
        for (size_t i = 0; i < rings.size(); ++i)
            way[rings[i]] = mean[i];
    }
}

void ContactBodies::exempt_stuck()
{
    std::vector<BodyCrossing> crossings;
    for (const CarriedStart::StuckPair& pair : stuck_)
        for (const int v : pair)
            for (const int w : pair)
                if (v < soup_.first_body && w >= soup_.first_body)
                    crossings.emplace_back(v, w);
    if (!crossings.empty())
        exempt_.add_body_crossings(crossings);
}

void ContactBodies::show_let_through()
{
    if (let_through_.any())
        exempt_.set_let_through(let_through_.released(), let_through_.owner_normal(),
                                let_through_.body_normal());
    else
        exempt_.set_let_through({}, {}, {});
}

/// Lets bodies through the cloth of blocked pairs. False if that changes nothing.
bool ContactBodies::release(View<const BlockedPair> blocked, bool is_last)
{
    std::vector<int> vertices;
    for (const BlockedPair& pair : blocked)
        if (is_with_body(pair.pair, soup_.first_body))
            std::copy_if(pair.pair.vertex.begin(), pair.pair.vertex.end(), std::back_inserter(vertices),
                         [&](int v) { return v < soup_.first_body; });
    const bool has_released = let_through_.release(vertices, is_last);
    show_let_through();
    return has_released;
}

/// Numbers the vertices of bodies after those of cloth.
void ContactBodies::set_crossings(View<const BodyCrossing> crossings, View<const unsigned char> inside)
{
    exempt_.set_inside(inside);
    std::vector<BodyCrossing> all(crossings.begin(), crossings.end());
    for (auto& [cloth, body] : all)
        body += soup_.first_body;
    exempt_.set_body_crossings(std::move(all));
}

int ContactBodies::first_stuck() const
{
    const CarriedStart::StuckPair& pair = stuck_.front();
    return *std::find_if(pair.begin(), pair.end(), [&](int v) { return v < soup_.first_body; });
}

void ContactBodies::close_let_through(View<const int> crossing)
{
    let_through_.close(crossing);
    show_let_through();
}

void ContactBodies::forget()
{
    let_through_.forget();
    show_let_through();
    stuck_.clear();
    has_begun_ = false;
}

} // namespace toile::collision
