#include "research/paper_rule/rule_weights.h"

#include <algorithm>

#include "research/paper_rule/gauss_legendre.h"
#include "research/paper_rule/near_samples.h"

namespace toile::research {

namespace {

/// Points per axis of the alternatives in figures 7 and 8.
constexpr int kNearOrder = 4;
constexpr int kSubdividedOrder = 2;

/// Rule for near and middle field in terms of phi and of the Gaussian.
template <int Dim>
struct NearMiddleRule {
    std::vector<QuadraturePoint<Dim>> points; ///< of phi
    double of_amplitude = 0.0;                ///< weight of the Gaussian's amplitude [m^Dim]
};

/// @param unit  the Gaussian of amplitude 1
template <int Dim>
NearMiddleRule<Dim> near_middle_rule(const NearField<Dim>& field, const Gaussian<Dim>& unit,
                                     const RuleSettings& settings)
{
    NearMiddleRule<Dim> rule;
    const auto add = [&](const Box<Dim>& box, int order) {
        const std::vector<QuadraturePoint<Dim>> points = gauss_legendre(box, order);
        rule.points.insert(rule.points.end(), points.begin(), points.end());
    };
    switch (settings.near_middle) {
    case NearMiddle::Stacked:
        add(field.middle, settings.order);
        rule.of_amplitude = stacking_correction(unit, field.near, rule.points);
        break;
    case NearMiddle::GaussLegendre:
        add(field.middle, settings.order);
        std::erase_if(rule.points, [&](const auto& point) { return field.near.contains(point.position); });
        add(field.near, kNearOrder);
        break;
    case NearMiddle::Subdivided:
        for (const Box<Dim>& box : boxes_around(field.near, field.middle))
            add(box, kSubdividedOrder);
        rule.of_amplitude = unit.integral(field.near);
        break;
    }
    return rule;
}

/// Weights of phi: the three fields one after the other; a vertex may occur several times.
template <int Dim>
std::vector<WeightedVertex> weights_of_density(const VoxelisedMesh<Dim>& mesh, int vertex,
                                               View<const double> u, const RuleSettings& settings)
{
    const NearField<Dim> field = near_field(mesh, vertex, u, settings);
    Gaussian<Dim> unit = field.gaussian;
    unit.amplitude = 1.0;
    const NearMiddleRule<Dim> rule = near_middle_rule(field, unit, settings);

    // The Gaussian's amplitude is a sum over samples.
    std::vector<WeightedVertex> weights;
    const std::vector<double> of_amplitude = amplitude_weights(unit, field.target);
    for (size_t s = 0; s < field.samples.size(); ++s)
        weights.push_back({field.samples[s], rule.of_amplitude * of_amplitude[s]});

    // Locate the points in their simplices.
    for (const QuadraturePoint<Dim>& point : rule.points)
        if (const auto located = mesh.locate(point.position))
            for (int corner = 0; corner <= Dim; ++corner)
                weights.push_back({located->vertex[corner], point.weight * located->weight[corner]});

    // Far: one vertex per cluster.
    for (const FarCluster& cluster : far_clusters(mesh, field.domains.middle, u, settings.cluster_count,
                                                  settings.seed + unsigned(vertex)))
        weights.push_back({cluster.vertex, cluster.volume});
    return weights;
}

} // namespace

template <int Dim>
NearField<Dim> near_field(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                          const RuleSettings& settings)
{
    NearField<Dim> field;
    field.domains = field_domains(mesh, vertex, u, settings.domains);
    field.near = mesh.grid().box_of(field.domains.near);
    field.middle = mesh.grid().box_of(field.domains.middle);
    field.samples = near_samples(mesh, field.domains.near, vertex, settings.sample_count);
    for (const int sample : field.samples) {
        field.target.samples.push_back(mesh.position(sample));
        field.target.values.push_back(u[sample]);
    }
    field.target.faces = face_centers(field.near);
    field.target.penalty = settings.penalty;
    field.gaussian = fit_gaussian<Dim>(mesh.position(vertex), field.near, field.target);
    return field;
}

template <int Dim>
std::vector<WeightedVertex> rule_weights(const VoxelisedMesh<Dim>& mesh, int vertex, View<const double> u,
                                         const RuleSettings& settings)
{
    std::vector<WeightedVertex> weights = weights_of_density(mesh, vertex, u, settings);
    std::stable_sort(weights.begin(), weights.end(),
                     [](const WeightedVertex& a, const WeightedVertex& b) { return a.vertex < b.vertex; });

    // Sum the entries of each vertex, and go from phi to b.
    std::vector<WeightedVertex> merged;
    for (const WeightedVertex& entry : weights) {
        const double weight = entry.weight * u[entry.vertex] / mesh.volume(entry.vertex);
        if (!merged.empty() && merged.back().vertex == entry.vertex)
            merged.back().weight += weight;
        else
            merged.push_back({entry.vertex, weight});
    }
    return merged;
}

template NearField<2> near_field(const VoxelisedMesh<2>&, int, View<const double>, const RuleSettings&);
template NearField<3> near_field(const VoxelisedMesh<3>&, int, View<const double>, const RuleSettings&);
template std::vector<WeightedVertex> rule_weights(const VoxelisedMesh<2>&, int, View<const double>,
                                                  const RuleSettings&);
template std::vector<WeightedVertex> rule_weights(const VoxelisedMesh<3>&, int, View<const double>,
                                                  const RuleSettings&);

} // namespace toile::research
