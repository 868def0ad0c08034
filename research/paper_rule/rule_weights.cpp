#include "research/paper_rule/rule_weights.h"

#include <algorithm>

#include "research/paper_rule/gauss_legendre.h"
#include "research/paper_rule/near_samples.h"

namespace toile::research {

namespace {

/// Weights of phi: the three fields one after the other; a vertex may occur several times.
std::vector<WeightedVertex> weights_of_density(const UvSurface& surface, int vertex, View<const double> u,
                                               const RuleSettings& settings)
{
    const NearField field = near_field(surface, vertex, u, settings);
    const std::vector<QuadraturePoint<2>> points = gauss_legendre(field.middle, settings.order);

    // Near: the amplitude is a sum over samples. The Gaussian counts for its integral less the points'
    // estimate of it.
    std::vector<WeightedVertex> weights;
    Gaussian<2> unit = field.gaussian;
    unit.amplitude = 1.0;
    const double correction = stacking_correction(unit, field.near, points);
    const std::vector<double> of_amplitude = amplitude_weights(unit, field.target);
    for (size_t s = 0; s < field.samples.size(); ++s)
        weights.push_back({field.samples[s], correction * of_amplitude[s]});

    // Middle: locate the points in their triangles.
    for (const QuadraturePoint<2>& point : points)
        if (const auto located = surface.locate(point.position))
            for (int corner = 0; corner < 3; ++corner)
                weights.push_back({located->vertex[corner], point.weight * located->weight[corner]});

    // Far: one vertex per cluster.
    for (const FarCluster& cluster : far_clusters(surface, field.domains.middle, u, settings.cluster_count,
                                                  settings.seed + unsigned(vertex)))
        weights.push_back({cluster.vertex, cluster.area});
    return weights;
}

} // namespace

NearField near_field(const UvSurface& surface, int vertex, View<const double> u, const RuleSettings& settings)
{
    NearField field;
    field.domains = field_domains(surface, vertex, u, settings.domains);
    field.near = surface.grid().box_of(field.domains.near);
    field.middle = surface.grid().box_of(field.domains.middle);
    field.samples = near_samples(surface, field.domains.near, vertex, settings.sample_count);
    for (const int sample : field.samples) {
        field.target.samples.push_back(surface.uv(sample));
        field.target.values.push_back(u[sample]);
    }
    field.target.faces = face_centers(field.near);
    field.target.penalty = settings.penalty;
    field.gaussian = fit_gaussian<2>(surface.uv(vertex), field.near, field.target);
    return field;
}

std::vector<WeightedVertex> rule_weights(const UvSurface& surface, int vertex, View<const double> u,
                                         const RuleSettings& settings)
{
    std::vector<WeightedVertex> weights = weights_of_density(surface, vertex, u, settings);
    std::stable_sort(weights.begin(), weights.end(),
                     [](const WeightedVertex& a, const WeightedVertex& b) { return a.vertex < b.vertex; });

    // Sum the entries of each vertex, and go from phi to b.
    std::vector<WeightedVertex> merged;
    for (const WeightedVertex& entry : weights) {
        const double weight = entry.weight * u[entry.vertex] / surface.area(entry.vertex);
        if (!merged.empty() && merged.back().vertex == entry.vertex)
            merged.back().weight += weight;
        else
            merged.push_back({entry.vertex, weight});
    }
    return merged;
}

} // namespace toile::research
