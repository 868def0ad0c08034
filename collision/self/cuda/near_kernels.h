#pragma once

#include "collision/geometry/cuda/surface_kernels.h"
#include "collision/self/pair_rules.h"

namespace toile::collision {

/// Bodies of a soup: no pairs within one.
struct Bodies {
    View<const int> rigid; ///< [vertices] see NearPairs

    TOILE_HD bool are_one(int a, int b) const
    {
        return !rigid.empty() && are_in_one_body(rigid[a], rigid[b]);
    }
};

/// Queries of vertices for triangles, in the order of the Hilbert curve.
struct VertexQueries {
    static constexpr bool kIsEdgeEdge = false;

    View<const std::array<int, 1>> vertices;
    View<const int> order; ///< [queries] slots in vertices
    BoxesAtPoints boxes;
    PairCorners corners;
    Bodies bodies;

    TOILE_HD int size() const { return order.size(); }
    TOILE_HD BoxNode operator[](int i) const
    {
        const int v = vertices[order[i]][0];
        return boxes.node(v, v);
    }
    TOILE_HD static int above(const BoxNode& /*vertex*/) { return -1; }
    TOILE_HD bool is_candidate(int v, int t) const
    {
        return !share_vertex(corners(v, t, false), false) && !bodies.are_one(v, corners.triangles[t][0]);
    }
};

/// Queries of edges for edges with a larger number, in the order of their tree.
struct EdgeQueries {
    static constexpr bool kIsEdgeEdge = true;

    View<const BoxNode> nodes; ///< [queries] the tree's items
    PairCorners corners;
    Bodies bodies;

    TOILE_HD int size() const { return nodes.size(); }
    TOILE_HD BoxNode operator[](int i) const { return nodes[i]; }
    TOILE_HD static int above(const BoxNode& edge) { return edge.last; }
    TOILE_HD bool is_candidate(int e, int f) const
    {
        return !share_vertex(corners(e, f, true), true) &&
               !bodies.are_one(corners.edges[e][0], corners.edges[f][0]);
    }
};

/// Candidates that a query stores while it counts them. A query with more searches again, and neighbouring
/// threads with it. Close layers have up to 30, layers of a pile more.
inline constexpr int kKeptCandidates = 64;

/// Counts the candidates of query i and stores the first kKeptCandidates.
template <typename Queries>
struct CountCandidates {
    Queries queries;
    ImplicitBoxTree tree;
    View<int> counts; ///< [primitives] out: indexed by the query's number
    View<int> kept;   ///< [kKeptCandidates * queries] out: item k of all queries contiguous

    TOILE_HD void operator()(int i) const
    {
        const BoxNode query = queries[i];
        int count = 0;
        tree.visit_overlapping(query, Queries::above(query), [&](int item) {
            if (!queries.is_candidate(query.last, item))
                return;
            if (count < kKeptCandidates)
                kept[count * queries.size() + i] = item;
            ++count;
        });
        counts[query.last] = count;
    }
};

/// Writes the candidates of query i at its offset, up to the capacity.
template <typename Queries>
struct ListCandidates {
    Queries queries;
    ImplicitBoxTree tree;
    View<const int> counts, kept;
    View<const long> first;  ///< [primitives] offsets, sums of counts
    int first_number;        ///< number of the first primitive among vertices and edges
    View<Record> candidates; ///< out

    TOILE_HD void operator()(int i) const
    {
        const BoxNode query = queries[i];
        long next = first[query.last];
        const auto list = [&](int item) {
            if (next < candidates.size())
                candidates[int(next)] = {first_number + query.last, item};
            ++next;
        };
        const int count = counts[query.last];
        if (count <= kKeptCandidates) {
            for (int k = 0; k < count; ++k)
                list(kept[k * queries.size() + i]);
            return;
        }
        tree.visit_overlapping(query, Queries::above(query), [&](int item) {
            if (queries.is_candidate(query.last, item))
                list(item);
        });
    }
};

/// Candidates of all queries: vertices with triangles, then edges with edges.
struct CandidateList {
    View<const Record> candidates; ///< first: a vertex, or vertex_count plus an edge
    int vertex_count;

    TOILE_HD bool is_edge_edge(const Record& candidate) const { return candidate.first >= vertex_count; }
    TOILE_HD int first_of(const Record& candidate) const
    {
        return candidate.first - (is_edge_edge(candidate) ? vertex_count : 0);
    }
};

/// Marks the pairs among the candidates.
struct TestCandidate {
    CandidateList list;
    View<const long> count; ///< [1] candidates found, also beyond the capacity
    PairCorners corners;
    View<const Vec3> x;
    Trajectories trajectories;
    double margin;
    View<const SoupExtent> extent; ///< [1]; empty: some vertex moves differently from the others
    View<unsigned char> is_pair;   ///< out: 0 or 1

    TOILE_HD void operator()(int i) const
    {
        is_pair[i] = (unsigned char)(i < count[0] && may_meet(list.candidates[i]) ? 1 : 0);
    }

private:
    TOILE_HD bool may_meet(const Record& candidate) const
    {
        const bool is_edge_edge = list.is_edge_edge(candidate);
        const std::array<int, 4> v = corners(list.first_of(candidate), candidate.second, is_edge_edge);
        return MayMeet{x, trajectories, margin, extent.empty() || extent[0].moving != 0}(v, is_edge_edge);
    }
};

/// Completes pair i and writes it to its sorted slot among the pairs of its query.
struct ReportPair {
    CandidateList list;
    View<const int> pairs_in_list; ///< [pairs] indices into the candidates
    View<const int> count;         ///< [1] number of pairs
    View<const Triangle> triangles;
    SurfaceEdgesView edges;
    View<const Vec3> x;
    View<NearPair> pairs; ///< out

    TOILE_HD void operator()(int i) const
    {
        if (i >= count[0])
            return;
        const Record record = at(i);
        const int slot = slot_of(record, i);
        if (slot < pairs.size())
            pairs[slot] = near_pair_at(triangles, edges, x, list.first_of(record), record.second,
                                       list.is_edge_edge(record));
    }

private:
    TOILE_HD Record at(int i) const { return list.candidates[pairs_in_list[i]]; }

    /// Candidates are sorted by query, but within one they have the order of the tree.
    TOILE_HD int slot_of(const Record& record, int i) const
    {
        int slot = i;
        for (int k = i - 1; k >= 0 && at(k).first == record.first; --k)
            slot -= int(at(k).second > record.second);
        for (int k = i + 1; k < count[0] && at(k).first == record.first; ++k)
            slot += int(at(k).second < record.second);
        return slot;
    }
};

/// Numbers of a search that the host reads.
struct SearchNumbers {
    long candidates; ///< found, also beyond the capacity
    int pairs;       ///< among the candidates within the capacity
    double surface;  ///< [m^2] DeviceSurface::surface()
};

struct CollectNumbers {
    View<const long> first;
    View<const int> count;
    View<const double> surface;
    View<SearchNumbers> numbers; ///< [1] out

    TOILE_HD void operator()(int /*i*/) const
    {
        numbers[0] = {first[first.size() - 1], count[0], surface[0]};
    }
};

} // namespace toile::collision
