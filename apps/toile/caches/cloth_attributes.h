#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/toile/cloth/vertex_values.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::app {

/// Names of the numbers that an export stores for each vertex of a cloth, in the order of its list.
std::vector<std::string> vertex_attributes(const scene::Export& entry);

/// These numbers of one cloth, as the maps of toile render show them (maps/vertex_map.h).
class ClothAttributes {
public:
    ClothAttributes(const scene::Export& entry, const scenes::ClothState& state);

    bool is_empty() const { return kinds_.empty(); }

    /// @param x     [vertices] [m]
    /// @param skin  in its place at that time; needed for gaps
    /// @return [attributes][vertices]; lengths in the unit of the export
    std::vector<std::vector<double>> at(View<const Vec3> x, const SkinDistance* skin) const;

private:
    std::vector<double> gaps(View<const Vec3> x, const SkinDistance& skin) const;

    std::vector<scene::ExportAttribute> kinds_; ///< of vertices
    std::optional<VertexStrain> strain_;
    double metres_per_unit_;
};

} // namespace toile::app
