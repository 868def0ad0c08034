#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "scenes/format/scene.h"

namespace toile::app {

/// Options that let the body move from the drape on.
struct ClipOptions {
    std::optional<std::string> clip; ///< of the body, or of the motion; none: the longest of the motion
    std::filesystem::path motion;    ///< file of the clip; empty: the body
    std::string map = "names";       ///< of a motion, see scene::AvatarMotion

    bool is_used() const { return clip || !motion.empty(); }
    bool is_mapped_by_file() const { return std::filesystem::path(map).extension() == ".json"; }
};

/// Largest speed [m/s] of the skin on its way from the bind pose to the first pose of a clip: a slow walk.
/// Faster bodies leave garments behind that hang by friction.
inline constexpr double kMaxBlendSpeed = 1.0;

/// What the scene of a draped garment simulates.
struct Continuation {
    scene::Avatar body;
    int frames = 60;
};

/// Lets a body blend from its bind pose into a clip below kMaxBlendSpeed, and play it to its end. Without a
/// clip it stands still.
/// @param body  in its bind pose, the mannequin or a file
/// @throws InvalidInput in one line: a map of an unknown kind, a clip that the body does not have, a motion
///         that does not fit it, and a first pose that takes longer than a pre-roll may last
Continuation continuation_of(const scene::Avatar& body, const ClipOptions& options);

} // namespace toile::app
