#include "apps/toile/fit/fit_pictures.h"

#include <array>
#include <cmath>
#include <numbers>
#include <string>

#include "apps/preview/colour_bar.h"
#include "apps/preview/value_view.h"

namespace toile::app {

namespace {

constexpr int kWidth = 480, kHeight = 640; ///< [pixels] of a view

preview::ValueView view_of(const FittedGarment& garment, const TriangleMesh& body, double azimuth_deg)
{
    preview::CameraSettings settings;
    settings.azimuth_deg = azimuth_deg;
    settings.elevation_deg = 5.0;
    const preview::Camera camera =
        preview::fit_camera(garment.mesh.positions, settings, double(kWidth) / kHeight);
    return {garment.mesh, body, camera, kWidth, kHeight};
}

} // namespace

std::vector<preview::Image> fit_pictures(const FittedGarment& garment, const std::vector<VertexMap>& maps,
                                         const TriangleMesh& body, const Vec3& front)
{
    const double azimuth_deg = std::atan2(front.x(), front.z()) * 180.0 / std::numbers::pi;
    const std::array<preview::ValueView, 2> views{view_of(garment, body, azimuth_deg),
                                                  view_of(garment, body, azimuth_deg + 180.0)};
    static const std::array<std::string, 2> kCaptions{"front", "back"};
    std::vector<preview::Image> pictures;
    for (const VertexMap& map : maps) {
        const std::array<preview::Image, 2> sides{views[0].picture(map.values, map.scale),
                                                  views[1].picture(map.values, map.scale)};
        pictures.push_back(preview::with_colour_bar(
            sides, kCaptions, {map.name + " (" + map.shown_unit + ")", map.scale, map.shown_per_value}));
    }
    return pictures;
}

std::vector<Vec3> colours_of(const VertexMap& map)
{
    std::vector<Vec3> colours;
    colours.reserve(map.values.size());
    for (const double value : map.values)
        colours.push_back(map.scale.colour(value));
    return colours;
}

} // namespace toile::app
