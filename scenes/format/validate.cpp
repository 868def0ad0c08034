#include "scenes/format/validate.h"

#include <nlohmann/json.hpp>

#include "scenes/format/checks/checks.h"
#include "scenes/format/field.h"
#include "scenes/format/range_check.h"

namespace toile::scenes {

void require_valid(const Scene& scene)
{
    const scene_format::Document document(scene.source.empty() ? "scene" : scene.source);
    scene_format::RangeCheck check(document, "");
    Scene visited = scene; // describe() serves readers too
    describe(check, visited);
    scene_format::require_consistent(document, scene);
}

std::vector<std::string> former_key_warnings_of(const Scene& scene)
{
    std::vector<std::string> warnings;
    for (size_t i = 0; i < scene.cloths.size(); ++i)
        if (const auto pattern = scene.cloths[i].pattern)
            warnings.push_back(scene.source.string() + ": cloths[" + std::to_string(i) +
                               "].pattern is the former name of print; write \"print\": \"" +
                               scene_format::word_of(*pattern) + "\"");
    return warnings;
}

} // namespace toile::scenes
