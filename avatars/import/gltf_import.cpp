#include "avatars/import/gltf_import.h"

#include <array>
#include <cctype>
#include <fstream>
#include <new>
#include <string_view>

#include "avatars/import/gltf_clips.h"
#include "avatars/import/gltf_meshes.h"
#include "core/base/error.h"

namespace toile::avatars {

bool is_gltf(const std::filesystem::path& file)
{
    std::string extension = file.extension().string();
    for (char& letter : extension)
        letter = char(std::tolower(static_cast<unsigned char>(letter)));
    if (extension == ".gltf" || extension == ".glb")
        return true;
    static constexpr std::string_view kMagic = "glTF";
    std::array<char, kMagic.size()> start{};
    std::ifstream(file, std::ios::binary).read(start.data(), start.size());
    return std::string_view(start.data(), start.size()) == kMagic;
}

RiggedModel import_gltf(const std::filesystem::path& file)
{
    try {
        GltfFile gltf(file);
        GltfAccessors accessors(gltf);
        ModelBuilder builder(file.string());
        const NodeTree tree = add_joints(gltf, builder.skeleton());
        const std::set<int> animated = nodes_with_moving_shapes(gltf);
        const auto shapes_of_node = GltfMeshes(gltf, accessors, tree, animated, builder).read();
        add_clips(gltf, accessors, tree, shapes_of_node, builder);
        return builder.finish();
    } catch (const std::bad_alloc&) {
        throw InvalidInput(file.string() + ": needs more memory than there is; the file is too large");
    }
}

} // namespace toile::avatars
