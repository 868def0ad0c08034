#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include "garment/pattern/pattern.h"
#include "scenes/drape/drape.h"
#include "scenes/drape/garment_mesh.h"

namespace toile::scenes {

/// A garment to be draped.
struct Garment {
    const DrapeGarment& settings;
    garment::Pattern pattern; ///< placed
    std::string fabric;       ///< preset of panels without one, or of the first if all have one

    /// Reads the pattern.
    /// @param settings  kept by reference
    /// @param shift     [m] added to the placement of the panels
    /// @throws InvalidInput for a file that can't be read
    Garment(const DrapeGarment& settings, const Vec3& shift);

    const std::string& name() const { return settings.name; }
    std::set<std::string> labels() const; ///< of edges

    /// Presets of panels that differ from `fabric`, by panel.
    std::map<std::string, std::string> panel_fabrics() const;

    bool is_placed_by_segments() const; ///< some of its panels are
};

/// A garment on the body.
struct WornGarment {
    const Garment& garment;
    GarmentMesh mesh;
    std::vector<Vec3> x;    ///< [welded vertices] [m]
    std::vector<Vec3> held; ///< [welded vertices] as it hung before its labels were released [m]

    GarmentSurface surface() const { return mesh.surface(x); }
};

} // namespace toile::scenes
