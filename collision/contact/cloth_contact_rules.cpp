#include "collision/contact/cloth_contact_rules.h"

#include <algorithm>
#include <limits>

#include "collision/contact/rules.h"

namespace toile::collision {

namespace {

/// Bounds of the slack, relative to the mean edge and to the largest thickness [-]; the smaller applies.
/// Cloth that deviates farther is searched for again, which costs less than ever more pairs for all. In a
/// stack of layers, a slack of many thicknesses makes pairs of every layer with as many others.
constexpr double kMaxSlack = 0.1, kMaxLayers = 1.0;
constexpr double kMinSlack = 0.03, kMinLayers = 0.25;
/// Largest slack where no cloth is near other cloth, relative to the mean edge [-]: in a sheet of even edges
/// it makes no pairs of neighbours.
constexpr double kClearSlack = 0.2;

/// Missing distance, relative to the mean edge [-], up to which pinched cloth is deflected.
constexpr double kMaxDeflection = 0.1;

/// Correction of limited cloth, relative to the mean edge and to the thickness [-], up to which pairs are not
/// searched for again. Cloth that is moved back further has met a pair that no term of contact holds: without
/// one the minimiser would go there again.
constexpr double kIgnoredCorrection = 0.02, kIgnoredLayers = 0.3;

/// Deviation of a pressing pair, relative to the mean edge [-], beyond which its normal is out of date.
constexpr double kSlid = 0.2;

/// Mean edge of cloth [m], or of rigid surfaces if there is no cloth.
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

CollisionFreeStep::Settings settings_for(const std::vector<ContactCloth>& cloths, double edge,
                                         int first_prescribed)
{
    CollisionFreeStep::Settings settings;
    settings.first_prescribed = first_prescribed;
    settings.max_deflection = kMaxDeflection * edge;
    settings.thickness = std::numeric_limits<double>::max();
    for (const ContactCloth& cloth : cloths) {
        settings.thickness = std::min(settings.thickness, cloth.thickness);
        for (const double thickness : cloth.vertex_thickness)
            settings.thickness = std::min(settings.thickness, thickness);
    }
    return settings;
}

/// Trajectories of rigid bodies, with weights relative to the mean vertex of cloth.
RigidTrajectories rigid_trajectories_of(const std::vector<ContactCloth>& cloths)
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

ClothContactRules::ClothContactRules(View<const Triangle> triangles, View<const Vec3> positions,
                                     const std::vector<ContactCloth>& cloths, View<const double> altitude,
                                     View<const unsigned char> is_open)
    : edge_(mean_edge(triangles, positions, rigid_bodies_of(cloths))),
      collision_free_step_(settings_for(cloths, edge_, positions.size())),
      bodies_(rigid_trajectories_of(cloths))
{
    for (const ContactCloth& cloth : cloths) {
        thickest_ = std::max(thickest_, cloth.thickness);
        for (int v = 0; v < cloth.vertex_count; ++v)
            half_thickness_.push_back(0.5 * cloth.thickness_at(v));
    }
    for (int v = 0, c = 0, last = 0; c < int(cloths.size()); ++c)
        for (last += cloths[c].vertex_count; v < last; ++v)
            if (!cloths[c].is_rigid)
                half_thickness_[v] = std::min(half_thickness_[v], 0.25 * altitude[v]);
    const double of_cloth = 0.5 * thickest_, gap = largest_gap(cloths);
    for (const unsigned char open : is_open) {
        half_thickness_.push_back((open != 0 ? 1.0 : kGuardGap) * gap);
        thickest_ = std::max(thickest_, of_cloth + half_thickness_.back());
    }
}

SlackBounds ClothContactRules::slack() const
{
    return {std::min(kMinSlack * edge_, kMinLayers * thickest_),
            std::min(kMaxSlack * edge_, kMaxLayers * thickest_)};
}

SlackBounds ClothContactRules::learned_slack(bool is_clear) const
{
    return is_clear ? SlackBounds{slack().min, kClearSlack * edge_} : slack();
}

double ClothContactRules::ignored_correction() const
{
    return std::min(kIgnoredCorrection * edge_, kIgnoredLayers * thickest_);
}
double ClothContactRules::slid() const { return kSlid * edge_; }

} // namespace toile::collision
