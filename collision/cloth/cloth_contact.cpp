#include "collision/cloth/cloth_contact.h"

#include <algorithm>
#include <limits>

#include "collision/cloth/pair_geometry.h"
#include "core/backend/stages.h"

namespace toile {

namespace {

/// How far a vertex may come from where it was expected: this much more than in the step before [-], what was
/// allowed then shrinking by a share each step.
constexpr double kMoreThanBefore = 1.5;
constexpr double kShrinking = 0.8;

/// Bounds of that, of the mean edge [-]: beyond the upper one neighbours in the same sheet become pairs.
constexpr double kMostSlack = 0.25;
constexpr double kLeastSlack = 0.03;

/// Distance that cloth is held back by, of the mean edge [-], for which it is not looked again.
constexpr double kHeldAside = 0.02;

/// Sliding of a pair that presses, of the mean edge [-], after which its normal is out of date.
constexpr double kSlid = 0.3;

/// Of cloth; rigid surfaces count where there is nothing else.
double mean_edge(View<const Triangle> triangles, View<const Vec3> x, const std::vector<int>& rigid)
{
    double sum[2] = {0.0, 0.0};
    int count[2] = {0, 0};
    for (const Triangle& t : triangles) {
        const int kind = !rigid.empty() && rigid[t[0]] >= 0 ? 1 : 0;
        for (int k = 0; k < 3; ++k)
            sum[kind] += (x[t[(k + 1) % 3]] - x[t[k]]).norm();
        count[kind] += 3;
    }
    const int kind = count[0] > 0 ? 0 : 1;
    return count[kind] > 0 ? sum[kind] / count[kind] : 0.0;
}

SafeStep::Settings settings_for(const std::vector<ContactCloth>& cloths)
{
    SafeStep::Settings settings;
    settings.thickness = std::numeric_limits<double>::max();
    for (const ContactCloth& cloth : cloths)
        settings.thickness = std::min(settings.thickness, cloth.thickness);
    return settings;
}

} // namespace

ClothContact::ClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                           const std::vector<ContactCloth>& cloths, View<const double> altitude)
    : near_(triangles, positions, rigid_bodies_of(cloths)),
      safe_(settings_for(cloths), rigid_bodies_of(cloths)),
      edge_(mean_edge(triangles, positions, rigid_bodies_of(cloths))),
      deviation_(positions.size(), Vec3::Zero()), motion_(positions.size())
{
    slack_.assign(positions.size(), kMostSlack * edge_);
    for (int c = 0; c < int(cloths.size()); ++c) {
        cloth_.insert(cloth_.end(), cloths[c].vertex_count, c);
        thickest_ = std::max(thickest_, cloths[c].thickness);
    }
    for (int v = 0; v < positions.size(); ++v) {
        const ContactCloth& cloth = cloths[cloth_[v]];
        half_thickness_.push_back(
            0.5 * (cloth.is_rigid ? cloth.thickness : std::min(cloth.thickness, 0.5 * altitude[v])));
    }
}

void ClothContact::begin_step(View<const Vec3> x, View<const Vec3> prediction)
{
    prediction_.assign(prediction.begin(), prediction.end());
    for (int v = 0; v < x.size(); ++v)
        motion_[v] = prediction[v] + deviation_[v] - x[v];
    look(x);
}

void ClothContact::look(View<const Vec3> x)
{
    const StageScope stage("collision/near_pairs");
    near_.find(x, motion_, slack_, thickest_, pairs_);
    safe_.begin(x, motion_, slack_, pairs_);
}

/// @param first_count  vertices of the pair's first side
double ClothContact::thickness_of(const std::array<int, 4>& vertex, int first_count) const
{
    double side[2] = {half_thickness_[vertex[0]], half_thickness_[vertex[3]]};
    for (int k = 1; k < 3; ++k) {
        double& half = side[k < first_count ? 0 : 1];
        half = std::min(half, half_thickness_[vertex[k]]);
    }
    return side[0] + side[1];
}

double ClothContact::thickness_of(const ContactPair& pair) const
{
    return thickness_of(pair.vertex, first_count(pair.kind == ContactKind::kClothEdgeEdge));
}

void ClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    for (const NearPair& near : pairs_) {
        if (!near.is_facing)
            continue;
        ContactPair pair;
        pair.vertex = near.vertex;
        pair.weight = near.weight;
        pair.normal = near.normal;
        pair.kind = near.is_edge_edge ? ContactKind::kClothEdgeEdge : ContactKind::kClothVertexFace;
        const double approach = std::min(near.normal.dot(pair.cloth_point(motion_)), 0.0);
        double slack = 0.0;
        for (const int v : near.vertex)
            slack = std::max(slack, slack_[v]);
        if (near.distance + approach <= thickness_of(pair) + 2.0 * slack)
            out.push_back(pair);
    }
}

bool ClothContact::advance(View<Vec3> x)
{
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double held = safe_.limit(x);
    if (held <= kHeldAside * edge_ && !has_slid(x))
        return false;
    for (int v = 0; v < x.size(); ++v) {
        motion_[v] = wanted[v] - x[v];
        slack_[v] = std::max(slack_[v], bounded_slack(motion_[v].norm()));
    }
    look(x);
    return true;
}

bool ClothContact::hold_back(View<Vec3> x) { return safe_.limit(x) > 0.0; }

/// True when a pair that presses at x has slid out of the place that its normal was found for.
bool ClothContact::has_slid(View<const Vec3> x) const
{
    const View<const Vec3> base = safe_.base();
    for (const NearPair& near : pairs_) {
        if (!near.is_facing)
            continue;
        Vec3 before = Vec3::Zero(), now = Vec3::Zero();
        for (int k = 0; k < 4; ++k) {
            before += near.weight[k] * base[near.vertex[k]];
            now += near.weight[k] * x[near.vertex[k]];
        }
        if (near.normal.dot(now) > thickness_of(near.vertex, first_count(near.is_edge_edge)))
            continue;
        const Vec3 moved = now - before;
        if ((moved - near.normal.dot(moved) * near.normal).norm() > kSlid * edge_)
            return true;
    }
    return false;
}

void ClothContact::end_step(View<const Vec3> x)
{
    for (int v = 0; v < x.size(); ++v) {
        const Vec3 deviation = x[v] - prediction_[v];
        const double error = (deviation - deviation_[v]).norm();
        slack_[v] = bounded_slack(std::max(kMoreThanBefore * error, kShrinking * slack_[v]));
        deviation_[v] = deviation;
    }
}

double ClothContact::bounded_slack(double slack) const
{
    return std::clamp(slack, kLeastSlack * edge_, kMostSlack * edge_);
}

void ClothContact::forget()
{
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), kMostSlack * edge_);
}

} // namespace toile
