#pragma once

#include <filesystem>
#include <memory>
#include <optional>

#include "avatars/load_avatar.h"
#include "scenes/format/scene.h"

namespace toile::scenes {

/// What a cache of a body does not say itself.
struct CacheSettings {
    std::optional<std::filesystem::path> mesh; ///< with its faces
    std::optional<double> fps;                 ///< [1/s]
    bool turns_bones = false;                  ///< see GeometryCache
};

/// Loads a body: the mannequin, a file of load_avatar(), or a cache (CachedAvatar).
/// @param settings  unit and axis are those of a cache's file where they are empty
/// @throws InvalidInput for a file that can't be read, a cache without samples, times, faces or area, with
///         times that do not increase, or with another number of vertices than its mesh
std::unique_ptr<avatars::Avatar> load_body(avatars::AvatarSettings settings, const CacheSettings& cache);

/// Loads the body of an avatar that is no shape. Its `motion` is not added.
std::unique_ptr<avatars::Avatar> load_body(const scene::Avatar& settings);

/// Unit of the lengths in an avatar's file: the scene's, the file's, or that of its format.
scene::LengthUnit unit_of_file(const scene::Avatar& settings);

} // namespace toile::scenes
