#include "core/pd/preconditioner/coupled_part.h"

#include <utility>

namespace toile {

namespace {

/// Calls visit(vertex, weight) for the vertices that a term acts on.
template <typename Visit>
void for_each_vertex(const FrozenTerm& term, const Visit& visit)
{
    for (int k = 0; k < 4; ++k)
        if (term.weight[k] != 0.0)
            visit(term.vertex[k], term.weight[k]);
}

} // namespace

std::vector<FrozenTerm> free_terms(const FrozenHessian& dH, View<const unsigned char> fixed)
{
    std::vector<FrozenTerm> terms;
    dH.append_terms(terms);
    for (FrozenTerm& term : terms)
        for (int k = 0; k < 4; ++k)
            if (term.vertex[k] < 0 || fixed[term.vertex[k]])
                term.weight[k] = 0.0;
    return terms;
}

CoupledPart::CoupledPart(const std::vector<FrozenTerm>& terms, View<const double> D)
    : blocks(D.size(), Mat3::Zero())
{
    // Find the vertices that share a term with another one.
    constexpr int kUncoupled = -1;
    std::vector<int> local(D.size(), kUncoupled);
    for (const FrozenTerm& term : terms) {
        int count = 0;
        for_each_vertex(term, [&](int v, double weight) {
            ++count;
            blocks[v] += weight * weight * term.stiffness;
        });
        if (count > 1)
            for_each_vertex(term, [&](int v, double) { local[v] = 0; });
    }
    for (int v = 0; v < D.size(); ++v)
        if (local[v] != kUncoupled) {
            local[v] = int(vertices.size());
            vertices.push_back(v);
        }

    // Build the pattern of the coupled part, then its values.
    std::vector<std::pair<int, int>> couplings;
    for (const FrozenTerm& term : terms)
        for_each_vertex(term, [&](int v, double) {
            for_each_vertex(term, [&](int u, double) {
                if (u < v)
                    couplings.emplace_back(local[u], local[v]);
            });
        });
    matrix = BlockMatrix(int(vertices.size()), couplings);
    for (int i = 0; i < int(vertices.size()); ++i)
        matrix.block(i, i) = D[vertices[i]] * Mat3::Identity() + blocks[vertices[i]];
    for (const FrozenTerm& term : terms)
        for_each_vertex(term, [&](int v, double weight_v) {
            for_each_vertex(term, [&](int u, double weight_u) {
                if (u != v)
                    matrix.block(local[u], local[v]) += weight_u * weight_v * term.stiffness;
            });
        });
}

} // namespace toile
