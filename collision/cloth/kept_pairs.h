#pragma once

#include <array>
#include <vector>

#include "collision/cloth/ordered_records.h"
#include "collision/ways.h"

namespace toile {

/// Pairs that a wide search has found, kept for as long as cloth stays about where it was then [Verlet 1967,
/// neighbour lists].
///
/// MayMeet asks how far two sides are apart, and along the direction between them how far they are to be.
/// What a vertex has come since the wide search, is to go, and may end beside takes from both no more than
/// its length, where it is not common to all: a pair that was farther apart than the margin and these lengths
/// is refused, so it need not be asked. A list of all pairs within margin + 2 reach is then complete where no
/// side spends more than `reach`. Vertices that do are strays; their pairs are searched for.
///
/// Of each search plan() is asked first; where it says so the wide search comes next, and keep(). may_meet()
/// and strays() are of that search.
class KeptPairs {
public:
    struct Pair {
        Record record;
        double distance; ///< [m] when it was kept
    };

    enum class Plan {
        kSearch, ///< for all pairs
        kKeep,   ///< the wide search first, then keep() and use what it has found
        kUse,    ///< what is kept, and a search around strays()
    };

    /// @param mean_edge  [m] of the soup
    explicit KeptPairs(double mean_edge) : mean_edge_(mean_edge) {}

    /// How pairs are best found. Drops the list where it no longer serves.
    /// @param x, ways, margin  as NearPairs::find is asked
    Plan plan(View<const Vec3> x, const Ways& ways, double margin);

    /// The margin of the wide search [m], for one that is asked for.
    double wide(double margin) const;

    /// Takes change_vertex_triangle() and change_edge_edge() for all pairs within wide(margin), in order.
    /// @param x, ways, margin  as plan() was told
    void keep(View<const Vec3> x, const Ways& ways, double margin);

    std::vector<Pair>& change_vertex_triangle() { return vertex_triangle_; }
    std::vector<Pair>& change_edge_edge() { return edge_edge_; }
    View<const Pair> vertex_triangle() const { return vertex_triangle_; }
    View<const Pair> edge_edge() const { return edge_edge_; }

    bool has_strays() const { return stray_count_ > 0; }
    View<const unsigned char> strays() const { return strays_; } ///< [vertices] where there are any

    /// False where MayMeet would refuse the pair, and where it is one of a stray.
    bool may_meet(const Pair& pair, const std::array<int, 4>& vertices, bool is_edge_edge,
                  double margin) const;

private:
    /// What a vertex spends beside what all do [m].
    struct Excursion {
        double come = 0.0;  ///< since the pose of the list
        double goes = 0.0;  ///< from x on
        double slack = 0.0; ///< beside that

        void add(const Excursion& other);
        double sum() const { return come + goes + slack; }
    };

    void begin_at(View<const Vec3> x);
    void measure(View<const Vec3> x, const Ways& ways);
    double reach(double margin) const;
    int mark_strays(double reach);
    bool would_serve(double margin);
    bool are_few(int vertices) const;

    double mean_edge_;
    std::vector<Vec3> base_; ///< [vertices] the pose of the list, or without one of the last search [m]
    Vec3 base_mean_ = Vec3::Zero();
    bool has_list_ = false;
    double complete_to_ = 0.0; ///< [m] distance that the list is complete to
    int uses_ = 0;             ///< searches for all pairs that the list has served
    int pause_ = 0;            ///< searches for all pairs before another list is tried
    std::vector<Pair> vertex_triangle_, edge_edge_;

    std::vector<Excursion> excursions_; ///< [vertices]
    Excursion most_;                    ///< of each, over all vertices
    std::vector<unsigned char> strays_;
    int stray_count_ = 0;
};

} // namespace toile
