#include "apps/toile/drape/continuation.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "avatars/model/motion.h"
#include "avatars/retarget/add_motion.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "scenes/colliders/load_body.h"

namespace toile::app {

namespace {

/// Shortest and longest PreRoll::ease [s]: clips begin at full speed, and scenes take no longer one.
constexpr double kMinEase = 0.5, kMaxEase = 60.0;
/// Ease is rounded up to parts of a second [1/s].
constexpr double kEaseSteps = 20.0;

void require_map(const ClipOptions& options)
{
    if (options.map == "names" || options.map == "cmu" || options.is_mapped_by_file())
        return;
    const std::string nearest = nearest_word(options.map, {"names", "cmu"});
    throw InvalidInput("--map " + options.map + ": must be names, cmu or the path of a .json file" +
                       (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?"));
}

/// The clip to play, which a motion adds to the avatar. @return its name there
std::string choose_clip(avatars::Avatar& avatar, const ClipOptions& options)
{
    if (!options.motion.empty())
        return add_motion(avatar, {options.motion, options.clip.value_or(""), options.map});
    if (avatar.is_static())
        throw InvalidInput(avatar.source() + ": has no clips, so --clip " + *options.clip +
                           " can't move it; use a .glb, .gltf or .fbx body with clips, or one with bones " +
                           "and a clip from another file by --motion");
    return avatar.clips()[size_t(avatar.clip_index(*options.clip))].name;
}

/// @return [s]
double choose_ease(avatars::Avatar& avatar, const avatars::Motion& motion)
{
    const double shortest = blend_duration(avatar, motion, kMaxBlendSpeed);
    const double ease = std::max(kMinEase, std::ceil(kEaseSteps * shortest) / kEaseSteps);
    if (!(ease <= kMaxEase))
        throw InvalidInput(avatar.source() + ": clip '" + motion.clip +
                           "' begins so far from the bind pose that the body takes " + short_text(shortest) +
                           " s to it at " + short_text(kMaxBlendSpeed) + " m/s; at most " +
                           short_text(kMaxEase) + " s are possible, let it begin where the body stands");
    return ease;
}

} // namespace

Continuation continuation_of(const scene::Avatar& body, const ClipOptions& options)
{
    Continuation continuation;
    continuation.body = body;
    if (!options.is_used())
        return continuation;
    require_map(options);

    // Find the clip, and the time that it takes to get to it.
    const std::unique_ptr<avatars::Avatar> avatar = scenes::load_body(body);
    avatars::Motion motion;
    motion.clip = choose_clip(*avatar, options);
    motion.pre_roll = {.hold = 0.0, .ease = choose_ease(*avatar, motion), .from_bind = true};

    // Play it to its end: sample 0 shows the bind pose, the last one the end of the clip.
    const double duration = avatar->clips()[size_t(avatar->clip_index(motion.clip))].duration;
    continuation.frames = 1 + int(std::ceil(end_time(motion, duration) * scenes::Scene{}.fps));
    continuation.body.preroll = {.hold = 0.0, .ease = motion.pre_roll.ease, .from_bind = true};
    continuation.body.speed = 1.0;
    if (options.motion.empty())
        continuation.body.clip = motion.clip;
    else
        continuation.body.motion =
            scene::AvatarMotion{options.motion, options.clip.value_or(""), options.map};
    return continuation;
}

} // namespace toile::app
