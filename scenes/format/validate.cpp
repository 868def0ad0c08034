#include "scenes/format/validate.h"

#include <nlohmann/json.hpp>

#include "scenes/format/checks.h"
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

} // namespace toile::scenes
