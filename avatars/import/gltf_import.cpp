#include "avatars/import/gltf_import.h"

#include <array>
#include <fstream>
#include <new>
#include <string_view>

#include "avatars/import/gltf_clips.h"
#include "avatars/import/gltf_meshes.h"
#include "avatars/import/gltf_uri.h"
#include "core/base/error.h"
#include "core/base/extension.h"

namespace toile::avatars {

bool is_gltf(const std::filesystem::path& file)
{
    if (const std::string extension = lower_case_extension(file); extension == ".gltf" || extension == ".glb")
        return true;
    static constexpr std::string_view kMagic = "glTF";
    std::array<char, kMagic.size()> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    return std::string_view(start.data(), start.size()) == kMagic;
}

namespace {

/// Reads joints, meshes and clips of a file, and makes the result from them.
/// @param finish  from ModelBuilder to the result
template <typename Finish>
auto import(const std::filesystem::path& file, const Finish& finish)
{
    try {
        GltfFile gltf(file);
        GltfAccessors accessors(gltf);
        ModelBuilder builder(file.string());
        const NodeTree tree = add_joints(gltf, builder.skeleton());
        const std::set<int> animated = nodes_with_moving_shapes(gltf);
        const auto shapes_of_node = GltfMeshes(gltf, accessors, tree, animated, builder).read();
        add_clips(gltf, accessors, tree, shapes_of_node, builder);
        return finish(builder);
    } catch (const std::bad_alloc&) {
        throw InvalidInput(file.string() + ": needs more memory than there is; the file is too large");
    }
}

} // namespace

RiggedModel import_gltf(const std::filesystem::path& file)
{
    return import(file, [](ModelBuilder& builder) { return builder.finish(); });
}

SkeletalMotion import_gltf_motion(const std::filesystem::path& file)
{
    return import(file, [](ModelBuilder& builder) { return builder.motion(); });
}

std::vector<std::filesystem::path> files_of_gltf(const std::filesystem::path& file)
{
    std::vector<std::filesystem::path> files;
    const GltfFile gltf(file);
    for (const char* key : {"buffers", "images"})
        for (int i = 0; i < gltf.list(key).size(); ++i) {
            try {
                if (const auto uri = gltf.list(key)[i].find("uri"); uri && !is_data_uri(uri->text()))
                    files.push_back(file.parent_path() / decode_path(*uri));
            } catch (const InvalidInput&) { // refused by import_gltf() where it matters
            }
        }
    return files;
}

} // namespace toile::avatars
