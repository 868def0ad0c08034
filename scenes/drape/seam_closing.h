#pragma once

#include <vector>

#include "scenes/drape/garment_mesh.h"

namespace toile::scenes {

/// Seams of a garment while threads pull them shut.
///
/// Threads that have become short are welded before the others are pulled on: until then the sheets beside
/// them are strangers to each other, and contact keeps them apart where their edges have wound around each
/// other.
class SeamClosing {
public:
    /// Gap of threads that are welded [m].
    static constexpr double kMaxGap = 0.002;

    /// @param mesh  kept by reference
    /// @param x     [vertices of the panels] [m]
    SeamClosing(const GarmentMesh& mesh, std::vector<Vec3> x);

    /// The panels, welded where seams are closed.
    GarmentSurface panels() const;

    /// The panels, welded where seams are closed, with a line for every thread that is open.
    GarmentSurface surface() const;

    /// Moves the panels with the surface.
    /// @param surface  [vertices of surface()] [m]
    void move(View<const Vec3> surface);

    /// Welds open threads shorter than kMaxGap. Changes the vertices of surface(); positions stay.
    /// @return number of threads
    int weld();

    bool are_closed() const;    ///< all seams
    bool can_weld() const;      ///< all threads that are open
    double open_length() const; ///< sum of the lengths of open threads [m]

    const std::vector<Vec3>& positions() const { return x_; } ///< [vertices of the panels] [m]

    /// Longest thread of each seam: now, or when it was welded. [seams] [m]
    std::vector<double> gaps() const;

private:
    const GarmentMesh& mesh_;
    garment::PatternMesh closed_;                       ///< the panels with the threads that are welded
    garment::SewnMesh sewn_;                            ///< of closed_
    std::vector<std::vector<std::array<int, 2>>> open_; ///< [seams][threads]
    std::vector<Vec3> x_;
    std::vector<double> welded_gap_; ///< [seams] longest when it was welded [m]
};

} // namespace toile::scenes
