#include "apps/toile/caches/written_exports.h"

#include <type_traits>

#include "core/base/error.h"
#include "scenes/format/document.h"
#include "scenes/format/reader.h"

namespace toile::app {

namespace {

/// Visitor of scenes/format/describe.h that writes an object as JSON.
class Writer {
public:
    template <typename T, typename... Rest>
    void field(const char* key, const T& value, const Rest&...)
    {
        if constexpr (std::is_enum_v<T>)
            json_[key] = scene_format::word_of(value);
        else
            json_[key] = value;
    }
    template <typename T, typename... Rest>
    requires std::is_enum_v<T>
    void field(const char* key, const std::vector<T>& values, const Rest&...)
    {
        json_[key] = nlohmann::ordered_json::array();
        for (const T value : values)
            json_[key].push_back(scene_format::word_of(value));
    }
    template <typename T, typename... Rest>
    void field(const char* key, const std::optional<T>& value, const Rest&... rest)
    {
        if (value)
            field(key, *value, rest...);
    }
    template <typename T, typename... Rest>
    void required(const char* key, const T& value, const Rest&... rest)
    {
        field(key, value, rest...);
    }
    void required(const char* key, const std::filesystem::path& value, const char*)
    {
        json_[key] = value.string();
    }
    void names(const char* key, const std::vector<std::string>& value, const char*)
    {
        if (!value.empty())
            json_[key] = value;
    }

    const nlohmann::ordered_json& json() const { return json_; }

private:
    nlohmann::ordered_json json_;
};

} // namespace

nlohmann::ordered_json json_of(const std::vector<scene::Export>& exports)
{
    nlohmann::ordered_json list = nlohmann::ordered_json::array();
    for (scene::Export entry : exports) {
        Writer writer;
        scene_format::describe(writer, entry);
        list.push_back(writer.json());
    }
    return list;
}

std::optional<std::vector<scene::Export>> exports_in(const std::filesystem::path& certificate)
{
    if (std::error_code error; !std::filesystem::is_regular_file(certificate, error))
        return std::nullopt;
    const scene_format::Document document(certificate);
    const scene_format::Json json = document.parse(scene_format::read_document(certificate, "certificate"));
    const std::string key = "exports";
    if (!json.is_object() || !json.contains(key))
        return std::nullopt;
    scene_format::require_array(document, json[key], key);
    std::vector<scene::Export> exports;
    for (size_t i = 0; i < json[key].size(); ++i) {
        const std::string at = scene_format::below(key, i);
        scene_format::require_object(document, json[key][i], at, scene_format::keys_of<scene::Export>());
        scene_format::Reader reader(document, json[key][i], at);
        scene_format::describe(reader, exports.emplace_back());
    }
    return exports;
}

} // namespace toile::app
