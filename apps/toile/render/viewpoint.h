#pragma once

#include <optional>
#include <string>
#include <variant>

#include "apps/preview/camera.h"
#include "apps/toile/terminal/command_line.h"
#include "core/compute/types.h"
#include "scenes/format/scene.h"

namespace toile::app {

/// What a camera looks at: everything, a point [m], or a cloth or avatar by name.
using CameraTarget = std::variant<std::monostate, Vec3, std::string>;

/// Where pictures are taken from, by options of the command line.
class ViewpointOptions {
public:
    /// Declares the options; outlives the parser.
    void add_to(CLI::App& parser);

    /// Replaces the settings that are given.
    /// @throws InvalidInput for an option out of range; so do target() and crop().
    void apply(scene::Render& render) const;
    CameraTarget target() const;
    preview::Crop crop() const;

private:
    std::optional<double> azimuth_deg_, elevation_deg_, zoom_;
    std::string target_, crop_;
};

} // namespace toile::app
