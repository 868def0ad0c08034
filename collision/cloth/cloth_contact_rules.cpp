#include "collision/cloth/cloth_contact_rules.h"

#include <algorithm>
#include <limits>

namespace toile {

namespace {

/// Bounds of how far a vertex may come from where it was expected, of the mean edge and of the largest
/// thickness [-], the smaller of both: cloth that strays farther is looked at again, which costs less than
/// ever more pairs for all. In a stack of layers a slack of many thicknesses makes pairs of every layer with
/// as many others.
constexpr double kMostSlack = 0.1, kMostLayers = 1.0;
constexpr double kLeastSlack = 0.03, kLeastLayers = 0.25;

/// Missing distance, of the mean edge [-], up to which cloth in a pinch gives way.
constexpr double kMostDeflection = 0.1;

/// Distance that cloth is held back by, of the mean edge [-], for which it is not looked again.
constexpr double kHeldAside = 0.02;

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

ClothContactRules::ClothContactRules(View<const Triangle> triangles, View<const Vec3> positions,
                                     const std::vector<ContactCloth>& cloths, View<const double> altitude)
    : edge_(mean_edge(triangles, positions, rigid_bodies_of(cloths))),
      safe_step_(settings_for(cloths, edge_)), bodies_(rigid_ways_of(cloths))
{
    for (const ContactCloth& cloth : cloths) {
        thickest_ = std::max(thickest_, cloth.thickness);
        half_thickness_.insert(half_thickness_.end(), cloth.vertex_count, 0.5 * cloth.thickness);
    }
    for (int v = 0, c = 0, last = 0; c < int(cloths.size()); ++c)
        for (last += cloths[c].vertex_count; v < last; ++v)
            if (!cloths[c].is_rigid)
                half_thickness_[v] = std::min(half_thickness_[v], 0.25 * altitude[v]);
}

SlackBounds ClothContactRules::slack() const
{
    return {std::min(kLeastSlack * edge_, kLeastLayers * thickest_),
            std::min(kMostSlack * edge_, kMostLayers * thickest_)};
}

double ClothContactRules::held_aside() const { return kHeldAside * edge_; }
double ClothContactRules::slid() const { return kSlid * edge_; }

} // namespace toile
