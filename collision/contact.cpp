#include "collision/contact.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Largest query radius [m]. Cloth that moves further relative to a collider in one step may pass it.
constexpr double kMaxRadius = 0.06;

/// Distance [m] that cloth may move from where its active pairs were found: beyond, a curved surface has left
/// its tangent plane by more than about half a millimetre (radius of curvature 5 cm).
constexpr double kTrust = 0.007;

/// The same at the end of a step, and depth [m] that a step may end with, for which nothing is looked at
/// again: cloth at rest costs nothing then.
constexpr double kEndTrust = 0.002;
constexpr double kLeftOver = 1e-4;

/// Margin [m] of a second look within a step, on top of the gap.
constexpr double kRevisionMargin = 0.003;

/// Relative change of the friction limits that calls for another minimisation [-]: cloth that lands. At 0.1 a
/// walking skirt was minimised three times a step for nothing that could be measured.
constexpr double kFrictionChange = 0.5;

bool is_vertex_pair(const ContactPair& pair)
{
    return pair.kind == ContactKind::kVertexFace || pair.kind == ContactKind::kVertexShape;
}

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
                 std::vector<ContactPartner> partners, const Settings& settings)
    : cloths_(std::move(cloths)), rigid_(rigid_bodies_of(cloths_)), partners_(std::move(partners)),
      settings_(settings), detector_(triangles, positions), carried_(positions.size()),
      detected_at_(positions.size()), nearest_(positions.size()), sides_(positions.size()),
      altitude_(shortest_altitudes(triangles, positions))
{
    for (int c = 0; c < int(cloths_.size()); ++c) {
        cloth_of_.insert(cloth_of_.end(), cloths_[c].vertex_count, c);
        largest_gap_ = std::max(largest_gap_, cloths_[c].gap);
    }
    TOILE_ASSERT(int(cloth_of_.size()) == positions.size());
    if (settings_.cloth_with_cloth)
        between_.emplace(triangles, positions, cloths_, altitude_);
}

void Contact::begin_step(const StepStart& start)
{
    start_ = start;
    has_cleared_ = false;
    carry_with_colliders();

    // Everything that the prediction could reach from the carried start, relative to the moved surfaces.
    double farthest = 0.0;
    for (int v = 0; v < start.x.size(); ++v)
        farthest = std::max(farthest, (start.prediction[v] - carried_[v]).norm());
    if (between_)
        between_->begin_step(start.x, start.prediction, start.fixed);
    detect(carried_, std::min(largest_gap_ + farthest, kMaxRadius));
}

void Contact::forget()
{
    memory_.forget();
    std::fill(nearest_.begin(), nearest_.end(), Nearest{});
    sides_.forget();
    if (between_)
        between_->forget();
}

/// Moves every vertex that was near a surface along with it, so that it is still on the right side of the
/// surface at t1.
void Contact::carry_with_colliders()
{
    parallel_for(kCpu, "contact/carry", start_.x.size(), [&](int v) {
        const Nearest& last = nearest_[v];
        Vec3 motion = Vec3::Zero();
        if (last.collider >= 0) {
            const ContactPartner& partner = partners_[last.collider];
            motion = partner.mesh ? partner.mesh->motion(last.feature, Vec3::Constant(1.0 / 3.0))
                                  : partner.shape->motion_from(last.point);
        }
        carried_[v] = start_.x[v];
        if (is_carried(motion))
            carried_[v] += motion;
    });
}

void Contact::detect(View<const Vec3> at, double radius)
{
    std::vector<ContactPair> pairs;
    if (!partners_.empty())
        find_colliders(at, radius, pairs);
    if (between_)
        between_->append_pairs(pairs);
    make_terms(pairs);
}

/// Appends the pairs with colliders, and learns which of them is nearest to each vertex.
void Contact::find_colliders(View<const Vec3> at, double radius, std::vector<ContactPair>& pairs)
{
    const StageScope stage("collision/detect");
    detected_at_.assign(at.begin(), at.end());
    DetectSettings settings;
    settings.radius = radius;
    settings.farthest_motion = kMaxCarrySpeed * start_.dt;
    settings.face_vertex = settings_.face_vertex;
    settings.edge_edge = settings_.edge_edge;
    detector_.move(detected_at_);
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (partners_[c].mesh)
            detector_.detect(*partners_[c].mesh, c, settings, pairs, &sides_);
        else
            detector_.detect(*partners_[c].shape, c, settings, pairs);
    }

    std::fill(nearest_.begin(), nearest_.end(), Nearest{});
    for (const ContactPair& pair : pairs) {
        if (!is_vertex_pair(pair))
            continue;
        const double gap = pair.gap(at);
        Nearest& nearest = nearest_[pair.vertex[0]];
        if (nearest.collider < 0 || gap < nearest.gap)
            nearest = {pair.collider, pair.feature, gap, pair.point};
    }
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

bool Contact::revise(View<Vec3> x)
{
    if (energy_.terms().empty() && !between_)
        return false;
    const bool friction_changed = update_normal_forces(x);
    const bool has_new_pairs = between_ && between_->advance(x, leaning(x));
    if (has_new_pairs || slid_away(x, kTrust)) {
        remember_start();
        detect(x, largest_gap_ + kRevisionMargin);
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

/// True when a vertex of a pair that presses moved further than `trust` [m] from where it was found.
bool Contact::slid_away(View<const Vec3> x, double trust) const
{
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const ContactPair& pair = energy_.terms()[i].pair;
        if (pair.is_between_cloths() || energy_.gap(i, x) > 0.5 * gap_of(pair))
            continue;
        for (int k = 0; k < pair.count(); ++k)
            if ((x[pair.vertex[k]] - detected_at_[pair.vertex[k]]).squaredNorm() > trust * trust)
                return true;
    }
    return false;
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

void Contact::end_step(View<const Vec3> x)
{
    if (!has_cleared_)
        remember([&](int i) { return energy_.slip(i, x); });
    active_count_ = memory_.size();
    min_gap_ = 0.0;
    for (int i = 0; i < int(energy_.terms().size()); ++i) {
        const double gap = energy_.terms()[i].pair.gap(x);
        min_gap_ = i == 0 ? gap : std::min(min_gap_, gap);
    }
    for (int c = 0; c < int(partners_.size()); ++c)
        if (partners_[c].mesh)
            sides_.learn(x, *partners_[c].mesh, c);
    if (between_)
        between_->end_step(x);
}

/// Looks where the cloth has come to and moves it out of what is still inside there. This correction does not
/// become velocity, or it would throw the cloth.
void Contact::clear(View<Vec3> x, View<Vec3> v)
{
    if (deepest(x) <= kLeftOver && !slid_away(x, kEndTrust))
        return;
    remember([&](int i) { return energy_.slip(i, x); });
    has_cleared_ = true;
    detect(x, largest_gap_ + kRevisionMargin);
    const StageScope stage("collision/clear");
    stop_at_surfaces(x, v);
    push_out(x);
}

/// What would have crossed stops: it loses the velocity that it was to have got there.
void Contact::keep_apart(View<Vec3> x, View<Vec3> v)
{
    if (!between_)
        return;
    const std::vector<Vec3> wanted(x.begin(), x.end());
    if (!between_->hold_back(x, leaning(x)))
        return;
    for (int i = 0; i < x.size(); ++i)
        v[i] += (x[i] - wanted[i]) / start_.dt;
}

/// Coulomb's law with the distance pushed out for the normal impulse [Macklin et al. 2014, eq. 24]. Nothing
/// of a stick stays for the next step: friction has undone it.
void Contact::resolve(View<Vec3> x, View<Vec3> v)
{
    if (slid_away(x, kEndTrust))
        detect(x, largest_gap_ + kRevisionMargin);
    const StageScope stage("collision/resolve");
    update_normal_forces(x);
    remember([](int) { return Vec3(Vec3::Zero()); });
    has_cleared_ = true;
    rub(x, v);
    push_out(x);
}

} // namespace toile
