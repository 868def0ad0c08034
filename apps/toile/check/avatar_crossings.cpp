#include "apps/toile/check/avatar_crossings.h"

#include <algorithm>

#include "core/mesh/weld.h"

namespace toile::app {

namespace {

/// Distance that a caught triangle of cloth reaches out of a pinch [m].
constexpr double kReach = 0.02;

/// Marks triangles that cross another one of their own surface. [triangles]
std::vector<char> crossing_themselves(const TriangleMesh& surface)
{
    // Texture seams duplicate vertices, whose triangles would touch each other: weld them.
    const Welded welded = weld(surface, 0.0);
    std::vector<Triangle> triangles = surface.triangles;
    for (Triangle& t : triangles)
        for (int& v : t)
            v = welded.source_of[size_t(welded.welded_of[size_t(v)])];
    std::vector<char> found(triangles.size(), 0);
    for (const collision::Crossing& crossing : collision::find_crossings(triangles, surface.positions))
        found[size_t(crossing.a)] = found[size_t(crossing.b)] = 1;
    return found;
}

} // namespace

AvatarCrossings find_avatar_crossings(const ScenePenetration& avatars, View<const Triangle> triangles,
                                      View<const Vec3> x)
{
    AvatarCrossings result;
    for (int b = 0; b < int(avatars.bodies().size()); ++b) {
        const collision::PenetrationMeter* meter = avatars.meter(b);
        if (meter == nullptr)
            continue;
        const TriangleMesh& surface = avatars.bodies()[size_t(b)].contact_surface();
        const std::vector<collision::Crossing> crossings =
            collision::find_crossings(triangles, x, surface.triangles, surface.positions);
        if (crossings.empty())
            continue; // the body's self-crossings cost more to find than the cloth's
        const std::vector<char> crosses_itself = crossing_themselves(surface);
        for (const collision::Crossing& crossing : crossings) {
            // A triangle that is caught at one end reaches out of the pinch with the other.
            const Triangle& cloth = triangles[crossing.a];
            const auto is_pinched = [&](const Vec3& at) { return meter->is_pinched(at, crosses_itself); };
            const auto is_caught = [&](int v) {
                return (x[v] - crossing.point).norm() < kReach && is_pinched(x[v]);
            };
            if (is_pinched(crossing.point) || std::any_of(cloth.begin(), cloth.end(), is_caught))
                result.pinched.push_back({b, crossing});
            else
                result.clean.push_back({b, crossing});
        }
    }
    return result;
}

} // namespace toile::app
