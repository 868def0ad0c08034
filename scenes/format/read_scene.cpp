#include "scenes/format/read_scene.h"

#include <array>
#include <fstream>
#include <string>

#include "core/base/error.h"
#include "scenes/format/checks.h"
#include "scenes/format/reader.h"

namespace toile::scenes {

namespace {

/// [bytes] Scenes with the longest lists of vertices are smaller; devices such as /dev/zero never end.
constexpr size_t kMaxFileSize = 64'000'000;

/// Replaces the path of every file alternative by the path of the existing file.
template <typename Object>
void resolve_files(const scene_format::Document& document, const std::string& list,
                   std::vector<Object>& objects)
{
    for (size_t i = 0; i < objects.size(); ++i)
        if (auto* file = std::get_if<std::filesystem::path>(&objects[i].shape))
            *file = document.existing_file(file->string(),
                                           scene_format::below(scene_format::below(list, i), "file"));
}

} // namespace

Scene read_scene(const std::filesystem::path& file)
{
    if (std::filesystem::is_directory(file))
        throw InvalidInput(file.string() + ": is a folder; name a scene file (.json)");
    std::ifstream stream(file, std::ios::binary);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be opened; check the path and its permissions");
    std::string text;
    std::array<char, 65536> block;
    do {
        stream.read(block.data(), block.size());
        text.append(block.data(), size_t(stream.gcount()));
        if (text.size() > kMaxFileSize)
            throw InvalidInput(file.string() + ": is larger than 64 MB; name a scene file (.json)");
    } while (stream);
    return parse_scene(text, file);
}

Scene parse_scene(const std::string& text, const std::filesystem::path& source)
{
    const scene_format::Document document(source);
    scene_format::Json json = document.parse(text);
    if (json.is_object())
        json.erase("$schema"); // for editors, which complete and check by it

    Scene scene;
    scene_format::require_object(document, json, "", scene_format::keys_of<Scene>());
    scene_format::Reader reader(document, json, "");
    describe(reader, scene);

    scene.source = source;
    if (scene.name.empty())
        scene.name = source.stem().string();
    scene_format::require_consistent(document, scene);
    resolve_files(document, "avatars", scene.avatars);
    resolve_files(document, "cloths", scene.cloths);
    resolve_files(document, "solids", scene.solids);
    return scene;
}

} // namespace toile::scenes
