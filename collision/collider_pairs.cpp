#include "collision/collider_pairs.h"

#include <algorithm>
#include <limits>

#include "core/backend/parallel.h"

namespace toile {

namespace {

/// Largest distance [m] looked at. Cloth that moves further relative to a collider in one step may pass it.
constexpr double kMaxReach = 0.06;

/// How far [m] the solver may take cloth from where it was expected before more pairs are looked for.
constexpr double kMargin = 0.003;

/// The reach of vertices whose pairs are kept.
constexpr double kNowhere = -std::numeric_limits<double>::infinity();

bool is_vertex_pair(const ContactPair& pair)
{
    return pair.kind == ContactKind::kVertexFace || pair.kind == ContactKind::kVertexShape;
}

} // namespace

ColliderPairs::ColliderPairs(View<const Triangle> triangles, View<const Vec3> positions,
                             std::vector<ContactPartner> partners, const Settings& settings,
                             const CudaSpace* space)
    : partners_(std::move(partners)), settings_(settings), detector_(triangles, positions),
      sides_(positions.size()), found_at_(positions.begin(), positions.end()), reach_(positions.size(), 0.0),
      wanted_(positions.size(), 0.0), nearest_(positions.size())
{
    if (space != nullptr && !empty())
        there_ = std::make_unique<HostedDetector>(*space, triangles, positions, partners_);
}

void ColliderPairs::find(const StepStart& start)
{
    if (empty())
        return;
    farthest_motion_ = kMaxCarrySpeed * start.dt;
    carry(start.x);
    for (int v = 0; v < start.x.size(); ++v) {
        const double motion = (start.prediction[v] - found_at_[v]).norm();
        wanted_[v] = reach_[v] = std::min(settings_.gap + kMargin + motion, kMaxReach);
    }
    pairs_.clear();
    look(found_at_);
}

/// Moves every vertex along with what is around it, so that it is still on the right side of a surface at t1.
void ColliderPairs::carry(View<const Vec3> x)
{
    parallel_for(kCpu, "contact/carry", x.size(), [&](int v) {
        const Vec3 motion = carrying_motion(x[v], nearest_[v]);
        found_at_[v] = motion.norm() <= farthest_motion_ ? Vec3(x[v] + motion) : x[v];
    });
}

/// That of the surface that was nearest [m]; where none was near, the middle of those of meshes around.
Vec3 ColliderPairs::carrying_motion(const Vec3& x, const Nearest& last) const
{
    if (last.collider >= 0) {
        const ContactPartner& partner = partners_[last.collider];
        return partner.mesh ? partner.mesh->motion(last.feature, Vec3::Constant(1.0 / 3.0))
                            : partner.shape->motion_from(last.point);
    }
    for (const ContactPartner& partner : partners_)
        if (partner.mesh && partner.mesh->is_moving())
            if (const Bounds& around = partner.mesh->last_motion().around(x); !around.empty())
                return around.center();
    return Vec3::Zero();
}

void ColliderPairs::find_again(View<const Vec3> x, View<const unsigned char> strays)
{
    if (empty() || std::find(strays.begin(), strays.end(), 1) == strays.end())
        return;
    for (int v = 0; v < x.size(); ++v) {
        wanted_[v] = kNowhere;
        if (!strays[v])
            continue;
        found_at_[v] = x[v];
        wanted_[v] = reach_[v] = settings_.gap + kMargin;
    }
    std::erase_if(pairs_, [&](const ContactPair& pair) {
        if (partners_[pair.collider].shape)
            return true;
        for (int k = 0; k < pair.count(); ++k)
            if (wanted_[pair.vertex[k]] != kNowhere)
                return true;
        return false;
    });
    look(x);
}

/// Adds the pairs that are wanted.
void ColliderPairs::look(View<const Vec3> x)
{
    const StageScope stage("collision/detect");
    DetectSettings settings;
    settings.radius = *std::max_element(wanted_.begin(), wanted_.end());
    settings.farthest_motion = farthest_motion_;
    settings.face_vertex = settings_.face_vertex;
    settings.edge_edge = settings_.edge_edge;
    detector_.move(x, wanted_);
    if (there_) {
        there_->detect(
            x, wanted_, settings,
            [this](int c, View<const double> in_front) { learn_clearance(c, in_front); }, pairs_);
        return take_nearest();
    }
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (partners_[c].mesh)
            detector_.detect(*partners_[c].mesh, c, settings, pairs_, &sides_);
        else
            detector_.detect(*partners_[c].shape, c, settings, pairs_);
    }
    take_nearest();
}

/// Of a mesh searched on a GPU, at the positions of the search.
void ColliderPairs::learn_clearance(int c, View<const double> in_front)
{
    Clearance& clearance = detector_.clearance_of(*partners_[c].mesh, c);
    for (int v = 0; v < in_front.size(); ++v)
        if (in_front[v] >= 0.0)
            clearance.learn(v, in_front[v], -1);
}

void ColliderPairs::take_nearest()
{
    std::fill(nearest_.begin(), nearest_.end(), Nearest{});
    for (const ContactPair& pair : pairs_) {
        if (!is_vertex_pair(pair))
            continue;
        const double gap = pair.gap(found_at_);
        Nearest& nearest = nearest_[pair.vertex[0]];
        if (nearest.collider < 0 || gap < nearest.gap)
            nearest = {pair.collider, pair.feature, gap, pair.point};
    }
}

bool ColliderPairs::mark_unseen(View<const Vec3> x, View<unsigned char> strays)
{
    bool any = false;
    if (empty())
        return any;
    detector_.move(x);
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (!partners_[c].mesh)
            continue;
        const Clearance& clearance = detector_.clearance_of(*partners_[c].mesh, c);
        for (int v = 0; v < x.size(); ++v)
            if (clearance.of(v) < settings_.gap && (x[v] - found_at_[v]).norm() > reach_[v] - settings_.gap) {
                strays[v] = 1;
                any = true;
            }
    }
    return any;
}

void ColliderPairs::learn_sides(View<const Vec3> x)
{
    if (empty())
        return;
    if (there_)
        return there_->learn_sides(x);
    detector_.move(x);
    for (int c = 0; c < int(partners_.size()); ++c)
        if (const MeshCollider* mesh = partners_[c].mesh)
            sides_.learn(x, *mesh, c, detector_.clearance_of(*mesh, c));
}

void ColliderPairs::forget()
{
    std::fill(nearest_.begin(), nearest_.end(), Nearest{});
    sides_.forget();
    if (there_)
        there_->forget();
}

} // namespace toile
