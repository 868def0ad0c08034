#pragma once

#include "collision/bvh/team_descent.h"
#include "collision/geometry/changed_primitives.h"
#include "collision/self/cuda/near_kernels.h"

namespace toile::collision {

/// Candidates of changed vertices, their triangles and their edges with all primitives, each once. One team
/// per thread of ChangedPrimitives.
struct NearbyCandidates {
    ChangedPrimitives changed;
    ImplicitBoxTree triangle_tree, edge_tree;
    VertexQueries vertices;
    EdgeQueries edges;

    TOILE_HD int team_count() const { return changed.thread_count(); }

    /// Calls take(slot, candidate), from any thread, for all candidates of team `i`; returns their number.
    template <typename Take>
    TOILE_HD int visit(int i, const TeamDescent& descent, const Take& take) const
    {
        int count = 0;
        const auto take_next = [&](int slot, const Record& candidate) { take(count + slot, candidate); };
        changed.visit(
            i, [&](int v) { count += visit_vertex(v, descent, take_next); },
            [&](int t) { count += visit_triangle(t, descent, take_next); },
            [&](int e) { count += visit_edge(e, descent, take_next); });
        return count;
    }

private:
    template <typename Take>
    TOILE_HD int visit_vertex(int v, const TeamDescent& descent, const Take& take) const
    {
        return descent.visit<1>(
            triangle_tree, boxes().node(v, v).box(), [&](int t, int) { return vertices.is_candidate(v, t); },
            [&](int slot, int t, int) {
                take(slot, {v, t});
            });
    }

    /// Pairs triangle t with unchanged vertices, which belong to the lowest of their triangles.
    template <typename Take>
    TOILE_HD int visit_triangle(int t, const TeamDescent& descent, const Take& take) const
    {
        const Box query = boxes().node(t, changed.triangles[t]).box();
        const auto accepts = [&](int other, int k) {
            const int v = changed.triangles[other][k];
            return changed.is_changed[v] == 0 && changed.edges.corners_of_vertex.of(v)[0] == 3 * other + k &&
                   boxes().node(v, v).box().overlaps(query) && vertices.is_candidate(v, t);
        };
        return descent.visit<3>(triangle_tree, query, accepts, [&](int slot, int other, int k) {
            take(slot, {changed.triangles[other][k], t});
        });
    }

    /// Pairs edge e with others; of two changed edges the lower one finds the pair.
    template <typename Take>
    TOILE_HD int visit_edge(int e, const TeamDescent& descent, const Take& take) const
    {
        const View<const std::array<int, 2>> ends = changed.edges.vertex;
        const auto accepts = [&](int f, int) {
            const bool is_others = f == e || (f < e && changed.has_changed(ends[f]));
            return !is_others && edges.is_candidate(std::min(e, f), std::max(e, f));
        };
        const int vertex_count = boxes().points.size();
        return descent.visit<1>(edge_tree, boxes().node(e, ends[e]).box(), accepts,
                                [&](int slot, int f, int) {
                                    take(slot, {vertex_count + std::min(e, f), std::max(e, f)});
                                });
    }

    TOILE_HD const BoxesAtPoints& boxes() const { return vertices.boxes; }
};

/// Teams of a block, and the stacks of their descents.
struct NearbyTeams {
    static constexpr int kTeams = 4, kThreads = kTeams * kWarp;
    static constexpr std::size_t kBytes = kTeams * TeamDescent::kStack * sizeof(int);
    using Block = toile::Block<kThreads>;

    TOILE_HD static int number(int block_number, const Block& block)
    {
        return block_number * kTeams + block.thread / kWarp;
    }
    TOILE_HD static TeamDescent descent(const Block& block)
    {
        int* const stack = static_cast<int*>(block.memory) + block.thread / kWarp * TeamDescent::kStack;
        return {Team{block.thread % kWarp}, {stack, TeamDescent::kStack}};
    }
};

/// Counts the candidates of a team. One more team counts 0, so that the last offset is the total.
struct CountNearbyCandidates {
    NearbyCandidates nearby;
    View<int> counts; ///< [teams + 1] out

    TOILE_HD void operator()(int block_number, const NearbyTeams::Block& block) const
    {
        const int i = NearbyTeams::number(block_number, block);
        if (i >= counts.size())
            return;
        const TeamDescent descent = NearbyTeams::descent(block);
        const int count = i < nearby.team_count() ? nearby.visit(i, descent, [](int, const Record&) {}) : 0;
        if (descent.team.thread == 0)
            counts[i] = count;
    }
};

/// Writes the candidates of a team at its offset, up to the capacity.
struct ListNearbyCandidates {
    NearbyCandidates nearby;
    View<const long> first;  ///< [teams + 1] offsets
    View<Record> candidates; ///< out: see CandidateList

    TOILE_HD void operator()(int block_number, const NearbyTeams::Block& block) const
    {
        const int i = NearbyTeams::number(block_number, block);
        if (i >= nearby.team_count() || first[i + 1] == first[i])
            return;
        nearby.visit(i, NearbyTeams::descent(block), [&](int slot, const Record& candidate) {
            if (first[i] + slot < candidates.size())
                candidates[int(first[i] + slot)] = candidate;
        });
    }
};

/// Sort key of pair i of a list by its numbers: vertex-triangle by vertex, triangle; then edge-edge.
struct KeyPair {
    CandidateList list;
    View<const int> pairs_in_list; ///< [pairs]
    long second_count;             ///< above any second number
    View<std::uint64_t> keys;      ///< [pairs] out
    View<int> values;              ///< [pairs] out

    TOILE_HD void operator()(int i) const
    {
        const Record record = list.candidates[pairs_in_list[i]];
        keys[i] = std::uint64_t(record.first * second_count + record.second);
        values[i] = pairs_in_list[i];
    }
};

/// Completes pair i of a sorted list.
struct ReportSortedPair {
    CandidateList list;
    View<const int> sorted; ///< [pairs] indices into the list
    View<const Triangle> triangles;
    SurfaceEdgesView edges;
    View<const Vec3> x;
    View<NearPair> pairs; ///< out

    TOILE_HD void operator()(int i) const
    {
        const Record record = list.candidates[sorted[i]];
        pairs[i] = near_pair_at(triangles, edges, x, list.first_of(record), record.second,
                                list.is_edge_edge(record));
    }
};

} // namespace toile::collision
