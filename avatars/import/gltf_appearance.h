#pragma once

#include <filesystem>

#include "avatars/model/appearance.h"

namespace toile::avatars {

/// Reads the colours of a glTF 2.0 model, on the triangles of import_gltf().
///
/// Read: base colour factors and textures, alpha modes, COLOR_0, KHR_texture_transform. What is neither
/// opaque nor masked is cut out at half its alpha. Left out: other textures and extensions, filters.
/// @throws InvalidInput as import_gltf(). Images that can't be read are told in `left_out`.
Appearance import_gltf_appearance(const std::filesystem::path& file);

} // namespace toile::avatars
