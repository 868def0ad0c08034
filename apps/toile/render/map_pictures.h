#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/preview/colour_bar.h"
#include "apps/toile/maps/fitted_garment.h"
#include "apps/toile/maps/vertex_map.h"
#include "apps/toile/render/film.h"
#include "apps/toile/terminal/command_line.h"

namespace toile::app {

/// Heat maps in place of colours, by options of the command line.
class MapOptions {
public:
    /// Declares the options; outlives the parser.
    void add_to(CLI::App& parser);

    bool is_given() const { return !name_.empty(); }
    /// @throws InvalidInput for an unknown name or an impossible range; so do the others.
    void require_valid() const;
    MapKind kind() const;
    /// Ends of the colours in the unit of the legend.
    std::optional<std::vector<double>> range() const;

private:
    std::string name_, range_;
};

/// Heat maps of the prepared pictures of a film, with the same colours in all of them.
class MapPictures {
public:
    /// Chooses the range of the colours from all pictures, unless it is given.
    /// @param film  with a scene; outlives this
    /// @throws InvalidInput if the film has no cloth of its scene, or no skin where the map needs one.
    MapPictures(Film& film, const MapOptions& options, bool quiet);

    const preview::Legend& legend() const { return legend_; }
    preview::Image picture(size_t shot);

private:
    struct ClothMap {
        TriangleMesh cloth;
        VertexMap map;
    };
    std::vector<ClothMap> maps(int frame);

    Film& film_;
    MapKind kind_;
    std::vector<std::optional<scenes::LoadedCloth>> cloths_; ///< [cloths of the scene] those of the film
    preview::Legend legend_;
};

} // namespace toile::app
