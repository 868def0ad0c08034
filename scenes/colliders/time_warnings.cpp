#include "scenes/colliders/time_warnings.h"

#include "core/base/number.h"
#include "scenes/format/cache_files.h"

namespace toile::scenes {

namespace {

/// Seconds that a cache may be shorter than the scene: rounding of its times.
constexpr double kRounding = 1e-6;

std::string seconds(double time) { return short_text(time) + " s"; }

/// What stands still at the wrong time; empty: nothing.
std::string warning_of(const scene::Avatar& settings, const SkinnedCollider& body, double scene_end)
{
    const scene::Preroll& preroll = settings.preroll;
    if (body.avatar().is_static())
        return preroll.hold > 0.0 || preroll.ease > 0.0 ? "shows one pose, so its preroll has no effect" : "";
    if (preroll.hold >= scene_end && scene_end > 0.0)
        return "does not move, for its preroll holds it for " + seconds(preroll.hold) +
               ", and the scene ends at " + seconds(scene_end);
    const std::optional<double> end = body.end_time();
    if (!end || *end >= scene_end - kRounding)
        return "";
    return "ends at " + seconds(*end) + ", and the scene at " + seconds(scene_end) + "; it is held there";
}

} // namespace

std::vector<std::string> time_warnings(const Scene& scene, const std::vector<Collider>& colliders)
{
    std::vector<std::string> warnings;
    for (const Collider& collider : colliders) {
        const scene::Avatar& settings = collider.body().settings();
        const auto* file = std::get_if<std::filesystem::path>(&settings.shape);
        if (file == nullptr || !scene_format::is_cache(*file))
            continue;
        const std::string text =
            warning_of(settings, *collider.body().skinned(), (scene.frames - 1) * scene.frame_duration());
        if (!text.empty())
            warnings.push_back("avatar \"" + settings.name + "\": " + file->string() + ": " + text);
    }
    return warnings;
}

} // namespace toile::scenes
