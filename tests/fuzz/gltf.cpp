#include "avatars/appearance/load_appearance.h"
#include "avatars/load_avatar.h"
#include "core/base/error.h"
#include "tests/fuzz/input_file.h"

/// Animated models in glTF. Buffers are embedded, or part of the same file (.glb).
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    using namespace toile;
    static const test::InputFile text(".gltf"), binary(".glb");
    const bool is_binary = size > 4 && std::string(reinterpret_cast<const char*>(data), 4) == "glTF";
    avatars::AvatarSettings settings;
    settings.file = (is_binary ? binary : text).write(data, size);
    try {
        const std::unique_ptr<avatars::Avatar> avatar = avatars::load_avatar(settings);
        std::vector<Vec3> x(std::size_t(avatar->vertex_count()));
        for (int clip = 0; clip < int(avatar->clips().size()); ++clip)
            avatar->pose({clip, 0.5 * avatar->clips()[std::size_t(clip)].duration},
                         avatars::identity_affine(), x);
        avatars::load_appearance(settings.file, avatar->triangles());
    } catch (const InvalidInput&) {
    }
    return 0;
}
