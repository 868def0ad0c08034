#include "collision/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Distance [m] that cloth may move from where its active pairs were found: beyond, a curved surface has left
/// its tangent plane by more than about half a millimetre (radius of curvature 5 cm).
constexpr double kTrust = 0.007;

/// The same at the end of a step, and depth [m] that a step may end with, for which nothing is looked at
/// again: cloth at rest costs nothing then.
constexpr double kEndTrust = 0.002;
constexpr double kLeftOver = 1e-4;

/// Relative change of the friction limits that calls for another minimisation [-]: cloth that lands. At 0.1 a
/// walking skirt was minimised three times a step for nothing that could be measured.
constexpr double kFrictionChange = 0.5;

/// Of the triangles around each vertex [m].
std::vector<double> shortest_altitudes(View<const Triangle> triangles, View<const Vec3> x)
{
    std::vector<double> shortest(x.size(), std::numeric_limits<double>::max());
    for (const Triangle& corner : triangles) {
        const std::array<Vec3, 3> side{x[corner[1]] - x[corner[0]], x[corner[2]] - x[corner[1]],
                                       x[corner[0]] - x[corner[2]]};
        const double longest = std::max({side[0].norm(), side[1].norm(), side[2].norm()});
        const double altitude = side[0].cross(side[1]).norm() / longest;
        for (const int v : corner)
            shortest[v] = std::min(shortest[v], altitude);
    }
    return shortest;
}

double largest_gap(const std::vector<ContactCloth>& cloths)
{
    double largest = 0.0;
    for (const ContactCloth& cloth : cloths)
        largest = std::max(largest, cloth.gap);
    return largest;
}

} // namespace

std::vector<int> rigid_bodies_of(const std::vector<ContactCloth>& cloths)
{
    std::vector<int> bodies;
    int count = 0;
    for (const ContactCloth& cloth : cloths)
        bodies.insert(bodies.end(), cloth.vertex_count, cloth.is_rigid ? count++ : -1);
    if (count == 0)
        bodies.clear();
    return bodies;
}

Contact::Contact(View<const Triangle> triangles, View<const Vec3> positions, std::vector<ContactCloth> cloths,
                 std::vector<ContactPartner> partners, const Settings& settings, const CudaSpace* space)
    : cloths_(std::move(cloths)), rigid_(rigid_bodies_of(cloths_)), settings_(settings),
      colliders_(triangles, positions, std::move(partners),
                 {largest_gap(cloths_), settings.face_vertex, settings.edge_edge}, space),
      altitude_(shortest_altitudes(triangles, positions))
{
    for (int c = 0; c < int(cloths_.size()); ++c)
        cloth_of_.insert(cloth_of_.end(), cloths_[c].vertex_count, c);
    TOILE_ASSERT(int(cloth_of_.size()) == positions.size());
    if (settings_.cloth_with_cloth)
        between_ = make_cloth_contact(triangles, positions, cloths_, altitude_, space);
}

void Contact::begin_step(const StepStart& start)
{
    start_ = start;
    has_cleared_ = false;
    if (between_)
        between_->begin_step(start);
    colliders_.find(start);
    make_terms();
}

void Contact::forget()
{
    memory_.forget();
    colliders_.forget();
    if (between_)
        between_->forget();
}

double Contact::add_gradient(View<const Vec3> x, View<Vec3> gradient) const
{
    return energy_.terms().empty() ? 0.0 : energy_.add_gradient(x, gradient);
}

bool Contact::activate(View<const Vec3> x) { return !energy_.terms().empty() && energy_.activate(x); }

void Contact::add_hessian_product(View<const Vec3> p, View<Vec3> out) const
{
    energy_.add_hessian_product(p, out);
}

DeviceActiveSet* Contact::on_device(const CudaSpace& space)
{
    if (!there_)
        there_ = std::make_unique<DeviceContactEnergy>(space);
    there_->take(energy_, start_.x.size());
    return there_.get();
}

bool Contact::revise(StepField x)
{
    if (energy_.terms().empty() && !between_)
        return false;
    const bool friction_changed = update_normal_forces(x.host());
    const bool has_new_pairs = between_ && between_->advance(x, [&] { return leaning(x.host()); });
    if (has_left(x.host(), kTrust) || has_new_pairs) {
        remember_start();
        find_again(x.host());
        return true;
    }
    return friction_changed;
}

/// For pairs found again within the step, which begin at t0 too: what had stuck by then.
void Contact::remember_start()
{
    remember([&](int i) {
        const ContactTerm& term = energy_.terms()[i];
        return Vec3(at_start(term.pair) - term.anchor);
    });
}

/// True when cloth has left the places that its pairs with colliders are good for: strays_ are marked.
bool Contact::has_left(View<const Vec3> x, double trust)
{
    strays_.assign(x.size(), 0);
    const bool slid = mark_slid(x, trust);
    return colliders_.mark_unseen(x, strays_) || slid;
}

/// Those of a pair that presses of which one has gone farther than `trust` [m] from where it was found.
bool Contact::mark_slid(View<const Vec3> x, double trust)
{
    const View<const Vec3> found_at = colliders_.found_at();
    bool any = false;
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const ContactPair& pair = energy_.terms()[i].pair;
        if (pair.is_between_cloths() || energy_.gap(i, x) > 0.5 * gap_of(pair))
            continue;
        bool has_slid = false;
        for (int k = 0; k < pair.count(); ++k)
            has_slid = has_slid || (x[pair.vertex[k]] - found_at[pair.vertex[k]]).norm() > trust;
        for (int k = 0; k < pair.count() && has_slid; ++k)
            strays_[pair.vertex[k]] = 1;
        any = any || has_slid;
    }
    return any;
}

/// The pairs of strays_.
void Contact::find_again(View<const Vec3> x)
{
    colliders_.find_again(x, strays_);
    make_terms();
}

/// Refreshes the lagged normal forces; true when friction limits changed noticeably.
bool Contact::update_normal_forces(View<const Vec3> x)
{
    double total = 0.0, change = 0.0;
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const ContactTerm& term = energy_.terms()[i];
        const double force = energy_.pressing_force(i, x);
        total += term.friction * force;
        change += term.friction * std::abs(force - term.normal_force);
        energy_.set_normal_force(i, force);
    }
    return change > kFrictionChange * total;
}

/// Keeps forces and sticking of the pairs that press, for their successors. The forces are the minimiser's:
/// clearing and the strain limit move cloth afterwards, out of pairs to the last bit.
/// @param slip  slip(term): what has slipped since the anchor [m]
template <typename Slip>
void Contact::remember(const Slip& slip)
{
    memory_.forget();
    for (int i = 0; i < int(energy_.terms().size()); ++i)
        memory_.keep(energy_.terms()[i], slip(i));
}

void Contact::end_step(StepField positions)
{
    const View<const Vec3> x = positions.host();
    if (!has_cleared_)
        remember([&](int i) { return energy_.slip(i, x); });
    active_count_ = memory_.size();
    min_gap_ = 0.0;
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const double gap = energy_.terms()[i].pair.gap(x);
        min_gap_ = i == 0 ? gap : std::min(min_gap_, gap);
    }
    colliders_.learn_sides(x);
    if (between_)
        between_->end_step(positions);
}

/// Looks where the cloth has come to and moves it out of what is still inside there. This correction does not
/// become velocity, or it would throw the cloth. Again in the same step, it forgets pairs that it has parted:
/// friction there would drag cloth that is caught.
void Contact::clear(StepField positions, StepField velocities)
{
    const View<const Vec3> reached = positions.host();
    if (!has_left(reached, kEndTrust) && deepest(reached) <= kLeftOver)
        return;
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    remember([&](int i) { return energy_.slip(i, x); });
    has_cleared_ = true;
    find_again(x);
    const StageScope stage("collision/clear");
    stop_at_surfaces(x, v);
    push_out(x);
}

/// What would have crossed stops: it loses the velocity that it was to have got there.
bool Contact::keep_apart(StepField x, StepField v)
{
    return between_ && between_->hold_back(x, v, start_.dt, [&] { return leaning(x.host()); });
}

/// Coulomb's law with the distance pushed out for the normal impulse [Macklin et al. 2014, eq. 24]. Nothing
/// of a stick stays for the next step: friction has undone it.
void Contact::resolve(StepField positions, StepField velocities)
{
    const View<Vec3> x = positions.change_on_host(), v = velocities.change_on_host();
    if (has_left(x, kEndTrust))
        find_again(x);
    const StageScope stage("collision/resolve");
    update_normal_forces(x);
    remember([](int) { return Vec3(Vec3::Zero()); });
    has_cleared_ = true;
    rub(x, v);
    push_out(x);
}

} // namespace toile
