#include "collision/cloth/cloth_contact.h"

#include <algorithm>
#include <limits>

#include "collision/cloth/safe_motion.h"
#include "core/backend/parallel.h"

namespace toile {

namespace {

/// How far a vertex may come from where it was expected: this much more than in the step before [-], what was
/// allowed then shrinking by a share each step.
constexpr double kMoreThanBefore = 1.5;
constexpr double kShrinking = 0.8;

/// Bounds of that, of the mean edge and of the largest thickness [-], the smaller of both: cloth that strays
/// farther is looked at again, which costs less than ever more pairs for all. In a stack of layers a slack of
/// many thicknesses makes pairs of every layer with as many others.
constexpr double kMostSlack = 0.1, kMostLayers = 1.0;
constexpr double kLeastSlack = 0.03, kLeastLayers = 0.25;

/// Missing distance, of the mean edge [-], up to which cloth in a pinch gives way.
constexpr double kMostDeflection = 0.1;

/// Distance that cloth is held back by, of the mean edge [-], for which it is not looked again.
constexpr double kHeldAside = 0.02;

/// Share of the thickness [-] that a pair must keep on its expected way, or it passes through.
constexpr double kPassing = 0.1;

/// Straying of a pair that presses, of the mean edge [-], after which its normal is out of date.
constexpr double kSlid = 0.2;

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

SafeStep::Settings settings_for(const std::vector<ContactCloth>& cloths, double edge)
{
    SafeStep::Settings settings;
    settings.most_deflection = kMostDeflection * edge;
    settings.thickness = std::numeric_limits<double>::max();
    for (const ContactCloth& cloth : cloths)
        settings.thickness = std::min(settings.thickness, cloth.thickness);
    return settings;
}

/// Bodies weigh what they do against the mean vertex of cloth.
RigidWays rigid_ways_of(const std::vector<ContactCloth>& cloths)
{
    double mass = 0.0;
    int count = 0;
    for (const ContactCloth& cloth : cloths)
        if (!cloth.is_rigid) {
            mass += cloth.mass;
            count += cloth.vertex_count;
        }
    const double unit = count > 0 ? mass / count : 1.0;
    std::vector<double> weights;
    for (const ContactCloth& cloth : cloths)
        if (cloth.is_rigid)
            weights.push_back(cloth.mass / unit);
    return {rigid_bodies_of(cloths), weights};
}

} // namespace

ClothContact::ClothContact(View<const Triangle> triangles, View<const Vec3> positions,
                           const std::vector<ContactCloth>& cloths, View<const double> altitude,
                           const CudaSpace* space)
    : edge_(mean_edge(triangles, positions, rigid_bodies_of(cloths))),
      near_(triangles, positions, rigid_bodies_of(cloths), space),
      exempt_(positions, altitude, SafeStep::Settings{}.least_gap),
      safe_(near_, exempt_, settings_for(cloths, edge_), rigid_ways_of(cloths)),
      deviation_(positions.size(), Vec3::Zero()), motion_(positions.size())
{
    for (const ContactCloth& cloth : cloths) {
        thickest_ = std::max(thickest_, cloth.thickness);
        half_thickness_.insert(half_thickness_.end(), cloth.vertex_count, 0.5 * cloth.thickness);
    }
    for (int v = 0, c = 0, last = 0; c < int(cloths.size()); ++c)
        for (last += cloths[c].vertex_count; v < last; ++v)
            if (!cloths[c].is_rigid)
                half_thickness_[v] = std::min(half_thickness_[v], 0.25 * altitude[v]);
    least_slack_ = std::min(kLeastSlack * edge_, kLeastLayers * thickest_);
    most_slack_ = std::min(kMostSlack * edge_, kMostLayers * thickest_);
    slack_.assign(positions.size(), least_slack_);
}

void ClothContact::begin_step(View<const Vec3> x, View<const Vec3> prediction,
                              View<const unsigned char> fixed)
{
    fixed_ = fixed;
    prediction_.assign(prediction.begin(), prediction.end());
    for (int v = 0; v < x.size(); ++v)
        motion_[v] = prediction[v] + deviation_[v] - x[v];
    look(x);
}

void ClothContact::look(View<const Vec3> x)
{
    const StageScope stage("collision/near_pairs");
    near_.find(x, {motion_, slack_}, thickest_, pairs_);
    std::erase_if(pairs_, [&](const NearPair& pair) { return exempt_.is_exempt(pair); });
    expected_.resize(x.size());
    for (int v = 0; v < x.size(); ++v)
        expected_[v] = x[v] + motion_[v];
    safe_.begin(x, expected_, slack_, fixed_, pairs_);
}

void ClothContact::append_pairs(std::vector<ContactPair>& out) const
{
    parallel_append(
        kCpu, "collision/cloth_terms", int(pairs_.size()),
        [&](int begin, int end, std::vector<ContactPair>& found) {
            for (int i = begin; i < end; ++i)
                if (const std::optional<ContactPair> pair = pressing_pair(pairs_[i]))
                    found.push_back(*pair);
        },
        out);
}

/// The half space that a pair should respect, if it may press at all: as it will be at the expected end of
/// the step, or as it is now where it would pass through on the way. Cloth that slides over a border must not
/// meet the direction in which the border was ahead of it.
std::optional<ContactPair> ClothContact::pressing_pair(const NearPair& now) const
{
    const double thickness = thickness_between(half_thickness_, now.vertex, first_count(now.is_edge_edge));
    double slack = 0.0;
    std::array<Vec3, 4> x, way;
    for (int k = 0; k < 4; ++k) {
        const int v = now.vertex[k];
        slack = std::max(slack, slack_[v]);
        x[k] = safe_.base()[v];
        way[k] = motion_[v];
    }
    const bool passes =
        safe_share(now.is_edge_edge, x, way, std::min(kPassing * thickness, 0.5 * now.distance)) < 1.0;
    const NearPair near = passes ? now : near_.at(expected_, now);
    // Around a border to the other side only goes what nothing has stopped yet: other pairs do.
    if (!passes && near.normal.dot(now.normal) < 0.0)
        return std::nullopt;
    if (!near.is_facing || (!passes && near.distance > thickness + 2.0 * slack))
        return std::nullopt;
    ContactPair pair;
    pair.vertex = near.vertex;
    pair.weight = near.weight;
    pair.normal = near.normal;
    pair.kind = near.is_edge_edge ? ContactKind::kClothEdgeEdge : ContactKind::kClothVertexFace;
    return pair;
}

bool ClothContact::advance(View<Vec3> x, View<const unsigned char> leans)
{
    const std::vector<Vec3> wanted(x.begin(), x.end());
    const double held = safe_.limit(x, leans);
    if (held <= kHeldAside * edge_ && !has_slid(x))
        return false;
    for (int v = 0; v < x.size(); ++v)
        motion_[v] = wanted[v] - x[v];
    look_on(x, wanted);
    return true;
}

bool ClothContact::hold_back(View<Vec3> x, View<const unsigned char> leans)
{
    const std::vector<Vec3> wanted(x.begin(), x.end());
    if (safe_.limit(x, leans) <= kHeldAside * edge_)
        return false;
    std::fill(motion_.begin(), motion_.end(), Vec3::Zero());
    look_on(x, wanted);
    return true;
}

/// From where cloth was brought back to, as far around its expected motion as it had wanted to go.
void ClothContact::look_on(View<const Vec3> x, View<const Vec3> wanted)
{
    for (int v = 0; v < x.size(); ++v)
        slack_[v] = std::max(slack_[v], bounded_slack((wanted[v] - x[v]).norm()));
    look(x);
}

/// True when a pair that presses at x has slid away from the place that its normal was expected at.
bool ClothContact::has_slid(View<const Vec3> x) const
{
    for (const NearPair& near : pairs_) {
        Vec3 strayed = Vec3::Zero();
        for (int k = 0; k < 4; ++k)
            strayed += near.weight[k] * (x[near.vertex[k]] - expected_[near.vertex[k]]);
        if (strayed.squaredNorm() <= kSlid * kSlid * edge_ * edge_)
            continue;
        const NearPair now = near_.at(x, near);
        if (now.is_facing &&
            now.distance <= thickness_between(half_thickness_, now.vertex, first_count(now.is_edge_edge)))
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
    return std::clamp(slack, least_slack_, most_slack_);
}

void ClothContact::forget()
{
    std::fill(deviation_.begin(), deviation_.end(), Vec3::Zero());
    std::fill(slack_.begin(), slack_.end(), least_slack_);
}

} // namespace toile
