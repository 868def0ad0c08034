#pragma once

#include <vector>

#include "scenes/drape/garment_mesh.h"

namespace toile::scenes {

/// Seams of a garment while threads pull them shut.
///
/// Threads that have become short are welded before the others are pulled on: until then the sheets beside
/// them are strangers to each other, and contact keeps them apart where their edges have wound around each
/// other.
///
/// Seams of the lowest order that is open are active: the threads of others neither pull nor are welded.
class SeamClosing {
public:
    /// Gap of threads that are welded [m].
    static constexpr double kMaxGap = 0.002;

    /// @param mesh   kept by reference
    /// @param x      [vertices of the panels] [m]
    /// @param order  [seams] lower ones are sewn first; empty: all at once
    SeamClosing(const GarmentMesh& mesh, std::vector<Vec3> x, std::vector<int> order = {});

    /// The panels, welded where seams are closed.
    GarmentSurface panels() const;

    /// The panels, welded where seams are closed, with a line for every active thread.
    GarmentSurface surface() const;

    /// Closures of the pattern as tacks between vertices of surface().
    std::vector<scene::Tack> tacks(const garment::Pattern& pattern) const;

    /// Moves the panels with the surface.
    /// @param surface  [vertices of surface()] [m]
    void move(View<const Vec3> surface);

    /// Welds active threads shorter than kMaxGap. Changes the vertices of surface(); positions stay.
    /// @return number of threads
    int weld();

    bool are_closed() const;    ///< all seams
    bool can_weld() const;      ///< all active threads
    double open_length() const; ///< sum of the lengths of active threads [m]
    int widest() const;         ///< active seam with the longest thread; -1: all are closed

    const std::vector<Vec3>& positions() const { return x_; } ///< [vertices of the panels] [m]

    /// Longest thread of each seam: now, or when it was welded. [seams] [m]
    std::vector<double> gaps() const;

private:
    using Threads = std::vector<std::array<int, 2>>;

    /// Seams that are active. They stay so until all of them are closed.
    std::vector<size_t> active() const;

    const GarmentMesh& mesh_;
    std::vector<int> order_;      ///< [seams]
    garment::PatternMesh closed_; ///< the panels with the threads that are welded
    garment::SewnMesh sewn_;      ///< of closed_
    std::vector<Threads> open_;   ///< [seams]
    std::vector<Vec3> x_;
    std::vector<double> welded_gap_; ///< [seams] longest when it was welded [m]
};

/// Order of each seam of a pattern. Seams of a panel with itself come before others of their order: what
/// pulls on a sleeve that is no tube yet twists its edges around each other.
std::vector<int> orders_of(const garment::Pattern& pattern);

} // namespace toile::scenes
