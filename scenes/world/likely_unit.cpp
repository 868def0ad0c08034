#include "scenes/world/likely_unit.h"

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "scenes/format/field.h"

namespace toile::scenes {

namespace {

/// Sizes of cloth over that of a body, or of people where there is none [-], between which a unit is
/// plausible: from a bow tie to a marquee.
constexpr double kSmallest = 0.02, kLargest = 12.0, kPerson = 1.7;

/// Largest avatar with a surface of its own.
std::pair<std::string, double> largest_body(const Scene& scene, const std::vector<Collider>& colliders)
{
    std::pair<std::string, double> largest{"", 0.0};
    for (size_t i = 0; i < colliders.size(); ++i) {
        const std::shared_ptr<const SkinnedCollider> skinned = colliders[i].body().skinned();
        if (!skinned)
            continue;
        std::vector<Vec3> x(size_t(skinned->vertex_count()));
        skinned->pose_t1(x);
        if (const double size = bounds(x).diagonal(); size > largest.second)
            largest = {scene.avatars[i].name, size};
    }
    return largest;
}

/// Plausible metric unit that makes the size most like the body's; none if no unit helps, or the present one
/// is plausible.
std::optional<scene::LengthUnit> likely_unit(double size, scene::LengthUnit present, double body)
{
    const auto is_plausible = [&](double metres) {
        return metres > kSmallest * body && metres < kLargest * body;
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
    const auto [body, body_size] = largest_body(scene, colliders);
    for (size_t i = 0; i < cloths.size(); ++i) {
        const scene::Cloth& cloth = scene.cloths[i];
        if (!std::holds_alternative<std::filesystem::path>(cloth.shape))
            continue;
        const double size = bounds(cloths[i].state().rest.positions).diagonal();
        const auto unit = likely_unit(size, cloth.unit, body.empty() ? kPerson : body_size);
        if (!unit)
            continue;
        char text[200];
        std::snprintf(text, sizeof text, ": is %.3g m long", size);
        std::string line = cloths[i].source() + text;
        if (!body.empty()) {
            std::snprintf(text, sizeof text, "\" is %.3g m", body_size);
            line += ", and \"" + body + text;
        }
        warnings.push_back(line + "; if its lengths are in " + scene_format::word_of(*unit) +
                           ", write \"unit\": \"" + scene_format::word_of(*unit) + "\"");
    }
    return warnings;
}

} // namespace toile::scenes
