#include "avatars/appearance/load_appearance.h"

#include "avatars/appearance/obj_appearance.h"
#include "avatars/import/assimp_import.h"
#include "avatars/import/gltf_appearance.h"
#include "avatars/import/gltf_import.h"
#include "core/base/extension.h"

namespace toile::avatars {

namespace {

Appearance import_appearance(const std::filesystem::path& file)
{
    if (lower_case_extension(file) == ".obj")
        return import_obj_appearance(file);
    return is_gltf(file) ? import_gltf_appearance(file) : import_model_appearance(file);
}

} // namespace

Appearance load_appearance(const std::filesystem::path& file, const std::vector<Triangle>& triangles)
{
    Appearance appearance = import_appearance(file);
    turn_corners(appearance, triangles, file.string());
    return appearance;
}

} // namespace toile::avatars
