#include "collision/collider_pairs.h"

#include <algorithm>

#include "core/backend/parallel.h"

namespace toile {

namespace {

bool is_vertex_pair(const ContactPair& pair)
{
    return pair.kind == ContactKind::kVertexFace || pair.kind == ContactKind::kVertexShape;
}

} // namespace

CarryingPartner carrying(const ContactPartner& partner)
{
    CarryingPartner carrying;
    if (partner.mesh) {
        carrying.is_mesh = true;
        carrying.is_moving = partner.mesh->is_moving();
    } else {
        carrying.pose_t1 = partner.shape->pose();
        carrying.shape_from_t0 = partner.shape->pose_t0().inverse();
    }
    return carrying;
}

ColliderPairs::ColliderPairs(View<const Triangle> triangles, View<const Vec3> positions,
                             std::vector<ContactPartner> partners, const Settings& settings)
    : partners_(std::move(partners)), settings_(settings), detector_(triangles, positions),
      sides_(positions.size()), found_at_(positions.begin(), positions.end()), reach_(positions.size(), 0.0),
      wanted_(positions.size(), 0.0), nearest_(positions.size())
{
}

void ColliderPairs::find(const StepStart& start)
{
    if (empty())
        return;
    farthest_motion_ = kMaxCarrySpeed * start.dt;
    carry(start.x);
    const ReachVertex reach{start.prediction, found_at_, settings_.gap};
    for (int v = 0; v < start.x.size(); ++v)
        wanted_[v] = reach_[v] = reach(v);
    pairs_.clear();
    look(found_at_);
}

void ColliderPairs::carry(View<const Vec3> x)
{
    std::vector<CarryingPartner> partners;
    for (const ContactPartner& partner : partners_) {
        partners.push_back(carrying(partner));
        if (!partner.mesh)
            continue;
        partners.back().mesh = partner.mesh->pose();
        partners.back().motion = partner.mesh->last_motion().view();
    }
    parallel_for(kCpu, "contact/carry", x.size(),
                 CarryVertex{partners, nearest_, x, farthest_motion_, found_at_});
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
        wanted_[v] = reach_[v] = settings_.gap + kReachMargin;
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
    for (int c = 0; c < int(partners_.size()); ++c) {
        if (partners_[c].mesh)
            detector_.detect(*partners_[c].mesh, c, settings, pairs_, &sides_);
        else
            detector_.detect(*partners_[c].shape, c, settings, pairs_);
    }
    take_nearest();
}

void ColliderPairs::take_nearest()
{
    std::fill(nearest_.begin(), nearest_.end(), NearestSurface{});
    for (const ContactPair& pair : pairs_)
        if (is_vertex_pair(pair))
            nearest_[pair.vertex[0]].consider(pair, found_at_);
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
        const MarkUnseen mark{detector_.clearance_of(*partners_[c].mesh, c).bounds(),
                              x,
                              found_at_,
                              reach_,
                              settings_.gap,
                              strays};
        for (int v = 0; v < x.size(); ++v)
            if (mark.is_unseen(v)) {
                mark(v);
                any = true;
            }
    }
    return any;
}

void ColliderPairs::learn_sides(View<const Vec3> x)
{
    if (empty())
        return;
    detector_.move(x);
    for (int c = 0; c < int(partners_.size()); ++c)
        if (const MeshCollider* mesh = partners_[c].mesh)
            sides_.learn(x, *mesh, c, detector_.clearance_of(*mesh, c));
}

void ColliderPairs::forget()
{
    std::fill(nearest_.begin(), nearest_.end(), NearestSurface{});
    sides_.forget();
}

} // namespace toile
