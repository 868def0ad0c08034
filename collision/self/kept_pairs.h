#pragma once

#include <array>
#include <vector>

#include "collision/geometry/trajectories.h"
#include "collision/self/ordered_records.h"

namespace toile::collision {

/// Pairs found by a search with a wide margin, kept while the cloth moves little [Verlet 1967, neighbour
/// lists].
///
/// MayMeet tests the distance of two sides at x, and at the end of their motion along the direction between
/// them. A vertex reduces both by at most the sum of three lengths: displacement since the wide search and
/// motion to come, each less the mean of all vertices, and slack. If the kept distance of a pair exceeds the
/// margin plus both sides' sums, MayMeet refuses it, so it need not be tested. A list of all pairs within
/// margin + 2 reach is therefore complete if no side's sum exceeds `reach`. Vertices that exceed it are out
/// of bounds; their pairs are searched for.
///
/// Each search calls plan() first. If that returns kKeep, the wide search and keep() follow. may_meet() and
/// out_of_bounds() refer to that search.
class KeptPairs {
public:
    struct Pair {
        Record record;
        double distance; ///< [m] when it was kept
    };

    enum class Plan {
        kSearch, ///< search without a list
        kKeep,   ///< search with the wide margin, keep() the pairs, then use them
        kUse,    ///< use the kept pairs, and search near out_of_bounds()
    };

    /// @param mean_edge  [m] of the soup
    explicit KeptPairs(double mean_edge) : mean_edge_(mean_edge) {}

    /// Cheapest method to find the pairs of a search. Drops the list when too many vertices are out of
    /// bounds.
    /// @param x, trajectories, margin  arguments of NearPairs::find
    Plan plan(View<const Vec3> x, const Trajectories& trajectories, double margin);

    /// Margin of the wide search [m] for a search with `margin`.
    double wide(double margin) const;

    /// Starts a list. change_vertex_triangle() and change_edge_edge() must hold all pairs within
    /// wide(margin), in order.
    /// @param x, trajectories, margin  as given to plan()
    void keep(View<const Vec3> x, const Trajectories& trajectories, double margin);

    std::vector<Pair>& change_vertex_triangle() { return vertex_triangle_; }
    std::vector<Pair>& change_edge_edge() { return edge_edge_; }
    View<const Pair> vertex_triangle() const { return vertex_triangle_; }
    View<const Pair> edge_edge() const { return edge_edge_; }

    bool has_out_of_bounds() const { return out_of_bounds_count_ > 0; }
    View<const unsigned char> out_of_bounds() const
    {
        return out_of_bounds_;
    } ///< [vertices] valid if has_out_of_bounds()

    /// False if MayMeet is certain to refuse the pair, or if one of its vertices is out of bounds.
    bool may_meet(const Pair& pair, const std::array<int, 4>& vertices, bool is_edge_edge,
                  double margin) const;

private:
    /// Lengths by which a vertex may approach others, without the motion common to all [m].
    struct Excursion {
        double come = 0.0;  ///< displacement since the pose of the list
        double goes = 0.0;  ///< displacement from x on
        double slack = 0.0; ///< see Trajectories

        void add(const Excursion& other);
        double sum() const { return come + goes + slack; }
    };

    void begin_at(View<const Vec3> x);
    void measure(View<const Vec3> x, const Trajectories& trajectories);
    double reach(double margin) const;
    int mark_out_of_bounds(double reach);
    bool would_serve(double margin);
    bool are_few(int vertices) const;

    double mean_edge_;
    std::vector<Vec3> base_; ///< [vertices] pose of the list, or of the last search if there is no list [m]
    Vec3 base_mean_ = Vec3::Zero();
    bool has_list_ = false;
    double complete_to_ = 0.0; ///< [m] distance up to which the list is complete
    int uses_ = 0;             ///< searches for all pairs that the list has served
    int pause_ = 0;            ///< searches for all pairs before another list is tried
    std::vector<Pair> vertex_triangle_, edge_edge_;

    std::vector<Excursion> excursions_; ///< [vertices]
    Excursion max_;                     ///< component-wise maximum over all vertices
    std::vector<unsigned char> out_of_bounds_;
    int out_of_bounds_count_ = 0;
};

} // namespace toile::collision
