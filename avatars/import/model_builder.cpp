#include "avatars/import/model_builder.h"

#include <cmath>
#include <set>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

bool is_finite(double value) { return std::isfinite(value); }
bool is_finite(const Vec3& value) { return value.allFinite(); }
bool is_finite(const Eigen::Quaterniond& value) { return value.coeffs().allFinite(); }

template <typename Value>
void require_usable_keys(const Track<Value>& track, const std::string& place)
{
    const auto refuse = [&](size_t key, const std::string& what) {
        throw InvalidInput(place + ": key " + std::to_string(key) + what);
    };
    for (size_t k = 0; k < track.keys.size(); ++k) {
        const double time = track.keys[k].time;
        if (!std::isfinite(time))
            refuse(k, " has time " + std::to_string(time) + "; times must be finite");
        if (k > 0 && time < track.keys[k - 1].time)
            refuse(k, " at " + std::to_string(time) + " s comes after one at " +
                          std::to_string(track.keys[k - 1].time) + " s; times must ascend");
        if (!is_finite(track.keys[k].value))
            refuse(k, " at " + std::to_string(time) + " s has a value that is not finite");
    }
    for (size_t k = 0; k < track.tangents.size(); ++k)
        if (!is_finite(track.tangents[k].in) || !is_finite(track.tangents[k].out))
            refuse(k, " has a tangent that is not finite");
}

} // namespace

std::vector<std::string> distinct_names(std::vector<std::string> names)
{
    std::set<std::string> taken(names.begin(), names.end()), seen;
    std::map<std::string, int> last_number;
    for (std::string& name : names) {
        if (seen.insert(name).second)
            continue;
        int& number = last_number.try_emplace(name, 1).first->second;
        std::string next;
        do
            next = name + "#" + std::to_string(++number);
        while (!taken.insert(next).second);
        seen.insert(next);
        name = next;
    }
    return names;
}

void require_usable(const Track<Vec3>& track, const std::string& place) { require_usable_keys(track, place); }

void require_usable(const Track<Eigen::Quaterniond>& track, const std::string& place)
{
    require_usable_keys(track, place);
    for (size_t k = 0; k < track.keys.size(); ++k)
        if (!(track.keys[k].value.squaredNorm() > 0.0))
            throw InvalidInput(place + ": key " + std::to_string(k) +
                               " is a quaternion of length 0; rotations have length 1");
}

void require_usable(const Track<double>& track, const std::string& place)
{
    require_usable_keys(track, place);
}

int ModelBuilder::add_bone(const Bone& bone)
{
    if (!bone.joint_from_mesh.allFinite())
        throw InvalidInput(source_ + ": the bone of joint '" + model_.skeleton.joints()[bone.joint].name +
                           "' has a matrix that is not finite");
    std::vector<double> key{double(bone.joint)};
    key.insert(key.end(), bone.joint_from_mesh.data(), bone.joint_from_mesh.data() + 12);
    const auto [known, is_new] = index_of_bone_.try_emplace(std::move(key), int(model_.mesh.bones.size()));
    if (is_new)
        model_.mesh.bones.push_back(bone);
    return known->second;
}

RiggedModel ModelBuilder::finish()
{
    require_surface();
    normalise_weights(model_.mesh, source_);
    turn_mirrored_triangles();
    weld();
    if (model_.mesh.rest.triangles.empty())
        throw InvalidInput(source_ +
                           ": every triangle has two corners in one point; an avatar needs a surface");
    return std::move(model_);
}

void ModelBuilder::weld()
{
    const std::vector<Triangle> added = model_.mesh.rest.triangles;
    const std::vector<int> welded_of =
        weld_seams(model_.mesh, kSeamDistance * bounds(model_.mesh.rest.positions).diagonal());
    for (size_t i = 0; i < added.size(); ++i) {
        const Triangle& t = added[i];
        if (has_three_corners({welded_of[size_t(t[0])], welded_of[size_t(t[1])], welded_of[size_t(t[2])]}))
            added_triangles_.push_back({int(i), t});
    }
}

SkeletalMotion ModelBuilder::motion()
{
    for (Clip& clip : model_.clips)
        clip.shape_tracks.clear();
    return {source_, std::move(model_.skeleton), std::move(model_.clips),
            !model_.mesh.rest.triangles.empty()};
}

void ModelBuilder::require_surface() const
{
    const TriangleMesh& surface = model_.mesh.rest;
    if (surface.triangles.empty())
        throw InvalidInput(source_ + ": no mesh with triangles; an avatar needs a surface");
    for (int t = 0; t < surface.triangle_count(); ++t)
        for (const int v : surface.triangles[t])
            if (v < 0 || v >= surface.vertex_count())
                throw InvalidInput(source_ + ": triangle " + std::to_string(t) + " names vertex " +
                                   std::to_string(v) + " of " + std::to_string(surface.vertex_count()));
    for (int v = 0; v < surface.vertex_count(); ++v)
        if (!surface.positions[v].allFinite())
            throw InvalidInput(source_ + ": position of vertex " + std::to_string(v) + " is not finite");
}

void ModelBuilder::turn_mirrored_triangles()
{
    const Skeleton& skeleton = model_.skeleton;
    std::vector<Affine> frames(size_t(skeleton.size()));
    joint_frames(skeleton, skeleton.rest_pose(), frames);
    std::vector<char> mirrors;
    for (const Bone& bone : model_.mesh.bones) {
        const Affine map = compose(frames[bone.joint], bone.joint_from_mesh);
        if (!map.allFinite())
            throw InvalidInput(source_ + ": joint '" + skeleton.joints()[bone.joint].name +
                               "': its transform in the bind pose is not finite");
        mirrors.push_back(map.leftCols<3>().determinant() < 0.0);
    }

    // A triangle is where the heaviest bone of its first corner takes it.
    for (Triangle& t : model_.mesh.rest.triangles)
        if (mirrors[model_.mesh.influences[model_.mesh.first[t[0]]].bone])
            std::swap(t[1], t[2]);
}

} // namespace toile::avatars
