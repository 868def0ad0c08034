#include "scenes/world/likely_unit.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "scenes/colliders/load_body.h"
#include "scenes/format/field.h"
#include "scenes/surfaces/load_solid.h"

namespace toile::scenes {

namespace {

/// Size of a person [m].
constexpr double kPerson = 1.7;

/// Sizes over that of a body, or of people where there is none [-], between which a unit is plausible.
struct Plausible {
    double smallest, largest;
};
constexpr Plausible kCloth{0.02, 12.0}; ///< from a bow tie to a marquee
constexpr Plausible kBody{0.02, 60.0};  ///< from a doll to a hall

std::string in_metres(double size)
{
    char text[40];
    std::snprintf(text, sizeof text, "%.3g m", size);
    return text;
}

/// Size of the surface of an avatar; 0 without one.
double size_of(const Collider& collider)
{
    const std::shared_ptr<const SkinnedCollider> skinned = collider.body().skinned();
    if (!skinned)
        return 0.0;
    std::vector<Vec3> x(size_t(skinned->vertex_count()));
    skinned->pose_t1(x);
    return bounds(x).diagonal();
}

/// Largest avatar with a surface of its own.
std::pair<std::string, double> largest_body(const Scene& scene, const std::vector<Collider>& colliders)
{
    std::pair<std::string, double> largest{"", 0.0};
    for (size_t i = 0; i < colliders.size(); ++i) {
        if (const double size = size_of(colliders[i]); size > largest.second)
            largest = {scene.avatars[i].name, size};
    }
    return largest;
}

/// Plausible metric unit that makes the size most like the body's; none if no unit helps, or the present one
/// is plausible.
std::optional<scene::LengthUnit> likely_unit(double size, scene::LengthUnit present, double body,
                                             const Plausible& plausible)
{
    const auto is_plausible = [&](double metres) {
        return metres > plausible.smallest * body && metres < plausible.largest * body;
    };
    if (is_plausible(size))
        return std::nullopt;
    std::optional<scene::LengthUnit> best;
    double least = std::numeric_limits<double>::infinity();
    using enum scene::LengthUnit;
    for (const scene::LengthUnit unit : {Metre, Centimetre, Millimetre}) {
        const double metres = size / scene::metres_per(present) * scene::metres_per(unit);
        if (const double factor = std::fabs(std::log(metres / body));
            is_plausible(metres) && factor < least) {
            least = factor;
            best = unit;
        }
    }
    return best;
}

} // namespace

std::vector<std::string> unit_warnings(const Scene& scene, const std::vector<SceneCloth>& cloths,
                                       const std::vector<Collider>& colliders)
{
    std::vector<std::string> warnings;
    const auto add = [&](const std::string& source, double size, scene::LengthUnit present,
                         const Plausible& plausible, double body, const std::string& comparison) {
        const auto unit = likely_unit(size, present, body, plausible);
        if (!unit)
            return;
        const std::string word = scene_format::word_of(*unit);
        warnings.push_back(source + ": is " + in_metres(size) + " long" + comparison +
                           "; if its lengths are in " + word + ", write \"unit\": \"" + word + "\"");
    };
    const auto [body, body_size] = largest_body(scene, colliders);
    const std::string comparison = body.empty() ? "" : ", and \"" + body + "\" is " + in_metres(body_size);
    for (size_t i = 0; i < cloths.size(); ++i)
        if (std::holds_alternative<std::filesystem::path>(scene.cloths[i].shape))
            add(cloths[i].source(), bounds(cloths[i].state().rest.positions).diagonal(),
                scene.cloths[i].unit.value_or(scene::LengthUnit::Metre), kCloth,
                body.empty() ? kPerson : body_size, comparison);
    for (size_t i = 0; i < colliders.size(); ++i)
        if (const auto* file = std::get_if<std::filesystem::path>(&scene.avatars[i].shape))
            add(file->string(), size_of(colliders[i]), unit_of_file(scene.avatars[i]), kBody, kPerson, "");
    for (const scene::Solid& solid : scene.solids)
        if (const auto* file = std::get_if<std::filesystem::path>(&solid.shape))
            add(file->string(), bounds(load_solid(solid).positions).diagonal(), solid.unit, kBody, kPerson,
                "");
    return warnings;
}

} // namespace toile::scenes
