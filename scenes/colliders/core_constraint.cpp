#include "scenes/colliders/core_constraint.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "collision/body/body_surfaces.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "core/compute/parallel.h"
#include "core/mesh/point_text.h"

namespace toile::scenes {

namespace {

/// Determinant of a vertex's map over the cube of its norm [-], at most 0.19 and that for turns and equal
/// scales. At less the map is flat: it has no inverse.
constexpr double kMinDeterminant = 1e-6;

} // namespace

CoreConstraint::CoreConstraint(const scene::Core& settings, View<const Vec3> start,
                               const std::vector<Collider>& colliders, const std::string& location)
    : collider_(index_of(colliders, settings.avatar)), first_{0}
{
    const Collider& collider = colliders[collider_];
    const collision::MeshCollider& mesh = *collider.contact_collider().mesh;
    const SkinnedCollider& body = *collider.body().skinned();
    std::vector<unsigned char> is_rigid(mesh.triangles().size(), 0);
    if (!settings.rigid_bones.empty())
        is_rigid = body.avatar().faces_on_bones(settings.rigid_bones, location + ".rigid_bones");
    double deepest = std::numeric_limits<double>::lowest();
    for (int v = 0; v < start.size(); ++v) {
        const collision::SurfacePoint at = *mesh.surface().closest(start[v]);
        deepest = std::max(deepest, -at.signed_distance);
        if (-at.signed_distance < settings.depth && is_rigid[at.triangle] == 0)
            continue;
        vertices_.push_back(v);
        bind(start[v], at, mesh.triangles()[at.triangle], body, location);
    }
    const std::string below = " m below the surface of \"" + settings.avatar + "\" at the start";
    if (vertices_.empty())
        throw InvalidInput(location + ": no vertex is " + short_text(settings.depth) + below +
                           "; the deepest is at " + short_text(deepest) +
                           " m. Give a smaller depth or cell, or move the body to where the avatar starts");
    if (int(vertices_.size()) == start.size())
        throw InvalidInput(location + ": all vertices are at least " + short_text(settings.depth) + below +
                           (settings.rigid_bones.empty() ? "" : " or at rigid_bones") +
                           ", so nothing is soft; give a larger depth");
    targets_.resize(vertices_.size());
}

/// Adds a vertex of the core, bound to the bones of a point of the avatar's surface.
void CoreConstraint::bind(const Vec3& start, const collision::SurfacePoint& at, const Triangle& corners,
                          const SkinnedCollider& body, const std::string& location)
{
    const avatars::SkinView skin = body.avatar().skin();
    avatars::Affine map = avatars::Affine::Zero();
    for (int k = 0; k < 3; ++k)
        for (int i = skin.first[corners[k]]; i < skin.first[corners[k] + 1]; ++i) {
            const avatars::Influence& of_corner = skin.influences[i];
            influences_.push_back({of_corner.bone, at.barycentric[k] * of_corner.weight});
            map += influences_.back().weight * body.bones_t1()[of_corner.bone];
        }
    first_.push_back(int(influences_.size()));
    const Mat3 linear = map.leftCols<3>();
    if (!(std::abs(linear.determinant()) > kMinDeterminant * std::pow(linear.norm(), 3))) {
        int nearest_corner;
        at.barycentric.maxCoeff(&nearest_corner);
        const std::string bone = body.avatar().bone_at(corners[nearest_corner]);
        throw InvalidInput(location + ": the vertex at " + point_text(start) + " m can't follow " +
                           (bone.empty() ? "the avatar" : "bone \"" + bone + "\"") +
                           ", which is flat at the start; give its bones a scale other than 0 there");
    }
    rest_.push_back(linear.inverse() * (start - map.col(3)));
}

bool CoreConstraint::has_jumped(const std::vector<Collider>& colliders, double dt) const
{
    if (!colliders[collider_].moved())
        return false;
    const SkinnedCollider& body = *colliders[collider_].body().skinned();
    for (int k = 0; k < int(rest_.size()); ++k)
        if (!((skin().posed(k, body.bones_t1()) - skin().posed(k, body.bones_t0())).norm() <=
              collision::BodySurfaces::kMaxSpeed * dt))
            return true;
    return false;
}

void CoreConstraint::follow(const std::vector<Collider>& colliders)
{
    const avatars::SkinView skin = this->skin();
    const View<const avatars::Affine> bones = colliders[collider_].body().skinned()->bones_t1();
    parallel_for(kCpu, "scenes/core", int(targets_.size()),
                 [&](int k) { targets_[k] = skin.posed(k, bones); });
}

} // namespace toile::scenes
