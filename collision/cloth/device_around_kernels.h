#pragma once

#include "collision/changed_primitives.h"
#include "collision/cloth/device_near_kernels.h"
#include "collision/team_descent.h"

namespace toile {

/// Candidates of changed vertices, their triangles and their edges with everything, each once. A team for
/// each thread of ChangedPrimitives.
struct CandidatesAround {
    ChangedPrimitives changed;
    ImplicitBoxTree triangle_tree, edge_tree;
    VertexQueries vertices;
    EdgeQueries edges;

    TOILE_HD int team_count() const { return changed.thread_count(); }

    /// Calls take(place, candidate), by any thread, for all that are team number `i`'s; returns how many.
    template <typename Take>
    TOILE_HD int visit(int i, const TeamDescent& descent, const Take& take) const
    {
        int count = 0;
        const auto take_next = [&](int place, const Record& candidate) { take(count + place, candidate); };
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
            [&](int place, int t, int) {
                take(place, {v, t});
            });
    }

    /// With unchanged vertices, which belong to the lowest of their triangles.
    template <typename Take>
    TOILE_HD int visit_triangle(int t, const TeamDescent& descent, const Take& take) const
    {
        const Box own = boxes().node(t, changed.triangles[t]).box();
        const auto accepts = [&](int other, int k) {
            const int v = changed.triangles[other][k];
            return changed.is_changed[v] == 0 && changed.edges.corners_of_vertex.of(v)[0] == 3 * other + k &&
                   boxes().node(v, v).box().overlaps(own) && vertices.is_candidate(v, t);
        };
        return descent.visit<3>(triangle_tree, own, accepts, [&](int place, int other, int k) {
            take(place, {changed.triangles[other][k], t});
        });
    }

    /// Of two changed edges the lower looks for the other.
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
                                [&](int place, int f, int) {
                                    take(place, {vertex_count + std::min(e, f), std::max(e, f)});
                                });
    }

    TOILE_HD const BoxesAtPoints& boxes() const { return vertices.boxes; }
};

/// Teams of a block, and the stacks of their descents.
struct TeamsAround {
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

/// Counts what a team finds; one more counts nothing, so that the sums end with that of all.
struct CountCandidatesAround {
    CandidatesAround around;
    View<int> counts; ///< [teams + 1] out

    TOILE_HD void operator()(int block_number, const TeamsAround::Block& block) const
    {
        const int i = TeamsAround::number(block_number, block);
        if (i >= counts.size())
            return;
        const TeamDescent descent = TeamsAround::descent(block);
        const int count = i < around.team_count() ? around.visit(i, descent, [](int, const Record&) {}) : 0;
        if (descent.team.thread == 0)
            counts[i] = count;
    }
};

/// Writes what a team finds where the sums of counts say, as far as there is room.
struct ListCandidatesAround {
    CandidatesAround around;
    View<const long> first;  ///< [teams + 1]
    View<Record> candidates; ///< out: as CandidateList has them

    TOILE_HD void operator()(int block_number, const TeamsAround::Block& block) const
    {
        const int i = TeamsAround::number(block_number, block);
        if (i >= around.team_count() || first[i + 1] == first[i])
            return;
        around.visit(i, TeamsAround::descent(block), [&](int place, const Record& candidate) {
            if (first[i] + place < candidates.size())
                candidates[int(first[i] + place)] = candidate;
        });
    }
};

/// The key of pair i of a list by its numbers: vertex-triangle by vertex, triangle; then edge-edge.
struct KeyPair {
    CandidateList list;
    View<const int> pairs_in_list; ///< [pairs]
    long second_count;             ///< more than any second number
    View<std::uint64_t> keys;      ///< [pairs] out
    View<int> values;              ///< [pairs] out

    TOILE_HD void operator()(int i) const
    {
        const Record record = list.candidates[pairs_in_list[i]];
        keys[i] = std::uint64_t(record.first * second_count + record.second);
        values[i] = pairs_in_list[i];
    }
};

/// Pair i in full, where it is in a sorted list.
struct ReportSortedPair {
    CandidateList list;
    View<const int> sorted; ///< [pairs] places in the list
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

} // namespace toile
