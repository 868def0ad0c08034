#include "apps/toile/render/viewpoint.h"

#include <sstream>

#include <CLI/CLI.hpp>

#include "apps/toile/render/number_list.h"
#include "core/base/error.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::app {

namespace {

constexpr double kLargestZoom = 1000.0;

void replace_if_given(double& value, const std::optional<double>& given, double lowest, double highest,
                      const char* option)
{
    if (!given)
        return;
    if (!(*given >= lowest && *given <= highest)) {
        std::ostringstream message;
        message << option << ": " << *given << " is out of range; give a number from " << lowest << " to "
                << highest;
        throw InvalidInput(message.str());
    }
    value = *given;
}

} // namespace

void ViewpointOptions::add_to(CLI::App& parser)
{
    parser.add_option("--azimuth", azimuth_deg_,
                      "Degrees from +Z towards +X to the camera, instead of the scene's");
    parser.add_option("--elevation", elevation_deg_,
                      "Degrees of the camera above the horizon, instead of the scene's");
    parser.add_option("--zoom", zoom_, "2 shows half as much, instead of the scene's");
    parser.add_option("--target", target_,
                      "X,Y,Z in metres, or a cloth or avatar that fills the picture [all]");
    parser.add_option("--crop", crop_,
                      "X0,Y0,X1,Y1: part of the picture that is rendered, in fractions from its upper left");
}

void ViewpointOptions::apply(scene::Render& render) const
{
    replace_if_given(render.azimuth_deg, azimuth_deg_, -3600.0, 3600.0, "--azimuth");
    replace_if_given(render.elevation_deg, elevation_deg_, -89.0, 89.0, "--elevation");
    replace_if_given(render.zoom, zoom_, 1.0 / kLargestZoom, kLargestZoom, "--zoom");
}

CameraTarget ViewpointOptions::target() const
{
    if (target_.empty())
        return {};
    const auto numbers = numbers_of(target_, 3);
    if (!numbers)
        return target_;
    const Vec3 point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    if (!is_in_range(point))
        throw InvalidInput("--target: " + target_ + " is out of range; give metres up to 100 km");
    return point;
}

preview::Crop ViewpointOptions::crop() const
{
    if (crop_.empty())
        return {};
    const auto numbers = numbers_of(crop_, 4);
    const std::string remedy =
        "; write X0,Y0,X1,Y1 with fractions of the picture from 0 to 1, X0 < X1 and Y0 < Y1";
    if (!numbers)
        throw InvalidInput("--crop: \"" + crop_ + "\" is not four numbers" + remedy);
    const preview::Crop crop{(*numbers)[0], (*numbers)[1], (*numbers)[2], (*numbers)[3]};
    constexpr double kLeast = 1e-3;
    if (!(crop.left >= 0.0 && crop.right <= 1.0 && crop.right - crop.left >= kLeast && crop.top >= 0.0 &&
          crop.bottom <= 1.0 && crop.bottom - crop.top >= kLeast))
        throw InvalidInput("--crop: " + crop_ + " is no part of the picture" + remedy);
    return crop;
}

} // namespace toile::app
