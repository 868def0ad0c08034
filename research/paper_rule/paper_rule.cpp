#include "research/paper_rule/paper_rule.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"
#include "core/linear/cholesky.h"
#include "core/linear/inverse_columns.h"

namespace toile::research {

namespace {

/// Fraction of u(i)^T H u(i) at or below which the rule's denominator is replaced by the exact one [-]. The
/// weight of vertex i can cancel to any value; smaller ones multiply x_i.
constexpr double kMinDenominator = 1e-6;

void require(bool is_usable, const std::string& what, double value, const std::string& range)
{
    if (!is_usable)
        throw InvalidInput("paper rule: " + what + " is " + short_text(value) + "; " + range + " needed");
}

void require_usable(const PaperRule::Settings& settings)
{
    const RuleSettings& rule = settings.rule;
    const DomainSettings& domains = rule.domains;
    require(domains.middle_influence > 0.0 && domains.middle_influence <= 1.0, "middle_influence",
            domains.middle_influence, "above 0 and at most 1");
    require(domains.near_influence > 0.0 && domains.near_influence <= domains.middle_influence,
            "near_influence", domains.near_influence, "above 0 and at most middle_influence");
    require(rule.sample_count >= 1, "sample_count", rule.sample_count, "at least 1");
    require(rule.penalty >= 0.0, "penalty", rule.penalty, "at least 0");
    require(rule.order == 3 || rule.order == 4, "order", rule.order, "3 or 4");
    require(rule.cluster_count >= 1, "cluster_count", rule.cluster_count, "at least 1");
    require(settings.applications >= 1, "applications", settings.applications, "at least 1");
}

/// Runs a kernel with one CPU thread per row.
template <typename Kernel>
void for_each_row(const char* name, int count, const Kernel& kernel)
{
    parallel_for(kCpu, name, count, [&](int i) { kernel(i, OneThread(), true); });
}

} // namespace

PaperRule::PaperRule(View<const Vec2> uv, View<const Triangle> triangles, Settings settings)
    : settings_(settings), mesh_(VoxelisedMesh<2>(uv, triangles, settings.voxels))
{
    require_usable(settings);
}

PaperRule::PaperRule(View<const Vec3> positions, View<const Simplex<3>> tets, Settings settings)
    : settings_(settings), mesh_(VoxelisedMesh<3>(positions, tets, settings.voxels))
{
    require_usable(settings);
}

int PaperRule::vertex_count() const
{
    return std::visit([](const auto& mesh) { return mesh.vertex_count(); }, mesh_);
}

PaperRule::Table::Table(const std::vector<std::vector<WeightedVertex>>& rows) : first(1, 0)
{
    for (const std::vector<WeightedVertex>& row : rows) {
        entries.insert(entries.end(), row.begin(), row.end());
        first.push_back(int(entries.size()));
    }
}

PaperRule::Table PaperRule::table_of(const SparseMatrix& H)
{
    std::vector<std::vector<WeightedVertex>> rows(H.rows());
    for (int i = 0; i < int(H.rows()); ++i)
        for (SparseMatrix::InnerIterator entry(H, i); entry; ++entry)
            if (entry.value() != 0.0)
                rows[i].push_back({int(entry.col()), entry.value()});
    return Table(rows);
}

void PaperRule::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    const int n = vertex_count();
    if (H.rows() != n || H.cols() != n || fixed.size() != n)
        throw InvalidInput("paper rule: H has " + std::to_string(H.rows()) + " rows and " +
                           std::to_string(fixed.size()) + " vertices may be fixed, but the mesh has " +
                           std::to_string(n));
    const Cholesky cholesky(H);
    const InverseColumns inverse(cholesky.factor());
    std::vector<int> free;
    for (int i = 0; i < n; ++i)
        if (!fixed[i])
            free.push_back(i);

    // Tabulate rows of free vertices, a block of kernel columns at a time; fixed ones keep b.
    std::vector<std::vector<WeightedVertex>> rows(n);
    for (int i = 0; i < n; ++i)
        if (fixed[i])
            rows[i] = {{i, 1.0}};
    const int blocks = (int(free.size()) + InverseColumns::kColumns - 1) / InverseColumns::kColumns;
    parallel_tasks(kCpu, blocks, [&](int task) {
        const int first = task * InverseColumns::kColumns;
        const int count = std::min(InverseColumns::kColumns, int(free.size()) - first);
        const View<const int> vertices(free.data() + first, count);
        InverseColumns::Block block;
        inverse.solve(vertices, block);
        std::vector<double> G(n);
        for (int column = 0; column < count; ++column) {
            for (int k = 0; k < n; ++k)
                G[k] = block[inverse.row_of(k)][column];
            rows[vertices[column]] = tabulate(vertices[column], G);
        }
    });
    rule_ = Table(rows);
    if (settings_.applications > 1)
        H_ = table_of(H);
}

std::vector<WeightedVertex> PaperRule::tabulate(int vertex, std::vector<double> G) const
{
    const double diagonal = G[vertex];
    for (double& value : G)
        value /= diagonal;
    const std::vector<double>& u = G;
    std::vector<WeightedVertex> weights = std::visit(
        [&](const auto& mesh) { return rule_weights(mesh, vertex, View<const double>(u), settings_.rule); },
        mesh_);

    // Divide by the rule's denominator, which is l_i times its weight of vertex i.
    double self_weight = 1.0;
    if (settings_.denominator == Denominator::SameRule) {
        const auto self = std::find_if(weights.begin(), weights.end(),
                                       [&](const WeightedVertex& entry) { return entry.vertex == vertex; });
        if (self != weights.end() && std::abs(self->weight) > kMinDenominator)
            self_weight = self->weight;
    }
    for (WeightedVertex& entry : weights)
        entry.weight *= diagonal / self_weight;
    return weights;
}

void PaperRule::solve(View<const Vec3> b, View<Vec3> x) const
{
    // x may be b.
    thread_local std::vector<Vec3> source, left;
    source.assign(b.begin(), b.end());
    for_each_row("paper_rule/solve", x.size(), ApplyRule{rule(), source, x});
    for (int done = 1; done < settings_.applications; ++done) {
        left.resize(source.size());
        for_each_row("paper_rule/residual", x.size(), RuleResidual{matrix(), source, x, left});
        for_each_row("paper_rule/correct", x.size(), CorrectByRule{rule(), left, x});
    }
}

} // namespace toile::research
