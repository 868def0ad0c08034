#include "avatars/import/name_pairs.h"

#include <fstream>

#include <nlohmann/json.hpp>

#include "core/base/error.h"

namespace toile::avatars {

std::vector<std::pair<std::string, std::string>> read_name_pairs(const std::filesystem::path& file)
{
    std::ifstream stream(file);
    if (!stream)
        throw InvalidInput(file.string() + ": can't be read; give the path of a map of joints");
    const nlohmann::json json = nlohmann::json::parse(stream, nullptr, false);
    if (!json.is_object() || json.empty())
        throw InvalidInput(file.string() + ": is no map of joints; write "
                                           "{\"joint of the body\": \"joint of the motion\", ...}");
    std::vector<std::pair<std::string, std::string>> pairs;
    for (const auto& [name, value] : json.items()) {
        if (!value.is_string())
            throw InvalidInput(file.string() + ": \"" + name + "\": " + value.dump() +
                               " is no name; write a joint of the motion in double quotes");
        pairs.emplace_back(name, value.get<std::string>());
    }
    return pairs;
}

} // namespace toile::avatars
