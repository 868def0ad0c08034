#include "apps/toile/terminal/scene_inputs.h"

#include <cctype>
#include <fstream>
#include <iterator>
#include <string>
#include <variant>
#include <vector>

#include <nlohmann/json.hpp>

namespace toile::app {

namespace {

using std::filesystem::path;

/// "a b" for "a%20b".
std::string without_percent_encoding(const std::string& uri)
{
    std::string text;
    for (size_t i = 0; i < uri.size(); ++i)
        if (uri[i] == '%' && i + 2 < uri.size() &&
            uri.find_first_not_of("0123456789abcdefABCDEF", i + 1) > i + 2) {
            text += char(std::stoi(uri.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            text += uri[i];
        }
    return text;
}

/// The JSON of a .gltf, or of a .glb: its first chunk, behind a header of 20 bytes. Discarded for other files
/// and damaged ones, which the importer refuses.
nlohmann::json gltf_json(const path& file)
{
    std::string extension = file.extension().string();
    for (char& letter : extension)
        letter = char(std::tolower(static_cast<unsigned char>(letter)));
    if (extension != ".gltf" && extension != ".glb")
        return nlohmann::json(nlohmann::json::value_t::discarded);
    std::ifstream stream(file, std::ios::binary);
    std::string text(std::istreambuf_iterator<char>(stream), {});
    if (text.starts_with("glTF") && text.size() >= 20) {
        const auto byte = [&](size_t at) { return size_t(static_cast<unsigned char>(text[at])); };
        text = text.substr(20, byte(12) | byte(13) << 8 | byte(14) << 16 | byte(15) << 24);
    }
    return nlohmann::json::parse(text, nullptr, false);
}

/// Files that a glTF names in its buffers and images.
std::vector<path> files_of_gltf(const path& file)
{
    std::vector<path> files;
    const nlohmann::json json = gltf_json(file);
    for (const char* list : {"buffers", "images"})
        if (json.is_object() && json.contains(list) && json[list].is_array())
            for (const auto& entry : json[list])
                if (entry.is_object() && entry.contains("uri") && entry["uri"].is_string())
                    if (const std::string uri = entry["uri"]; !uri.starts_with("data:"))
                        files.push_back(file.parent_path() / without_percent_encoding(uri));
    return files;
}

template <typename Object>
void add_file_of(FilePlan& plan, const Object& object, const std::string& kind)
{
    const path* file = std::get_if<path>(&object.shape);
    if (file == nullptr)
        return;
    const std::string role = "the file of " + kind + " \"" + object.name + "\"";
    plan.add_input(*file, role);
    for (const path& part : files_of_gltf(*file))
        plan.add_input(part, "a part of " + file->string());
}

} // namespace

void add_inputs(FilePlan& plan, const scenes::Scene& scene)
{
    plan.add_input(scene.source, "the scene");
    for (const scene::Cloth& cloth : scene.cloths)
        add_file_of(plan, cloth, "cloth");
    for (const scene::Solid& solid : scene.solids)
        add_file_of(plan, solid, "solid");
    for (const scene::Avatar& avatar : scene.avatars)
        add_file_of(plan, avatar, "avatar");
}

} // namespace toile::app
