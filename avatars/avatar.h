#pragma once

#include <string>
#include <vector>

#include "avatars/skeleton.h"
#include "avatars/skinning_kernels.h"

namespace toile {

/// What of an avatar's motion to show. Which clip time belongs to which simulation time is motion.h's matter.
struct PoseAt {
    int clip = -1;           ///< index in Avatar::clips(), or -1 for the bind pose
    double time = 0.0;       ///< [s] of the clip, 0 to its duration
    double bind_share = 0.0; ///< [-] 0 shows the clip, 1 the bind pose, between them a blend
    int cycles = 0;          ///< full clips already walked; moves the figure on by as many root travels

    bool operator==(const PoseAt&) const = default;
};

/// A body as the simulation sees it: fixed triangles whose vertices can be asked for at any clip time, or
/// only the bones that they follow. The vertex order is that of the triangles and never changes.
class Avatar {
public:
    struct ClipName {
        std::string name;
        double duration; ///< [s]
    };

    virtual ~Avatar() = default;
    Avatar(const Avatar&) = delete;
    Avatar& operator=(const Avatar&) = delete;

    /// Where it came from, for messages: a file name, or "mannequin".
    const std::string& source() const { return source_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    int vertex_count() const { return vertex_count_; }

    /// What it can do. Empty: it has one pose only.
    const std::vector<ClipName>& clips() const { return clips_; }
    bool is_static() const { return clips_.empty(); }

    /// Index in clips().
    /// @throws InvalidInput naming the nearest clip and listing all.
    int clip_index(const std::string& name) const;

    /// Marks the faces that follow one of these bones, or a bone below one of them in the skeleton: a face
    /// follows the bone with the most skin weight over its three corners, of equals the first in the
    /// skeleton.
    /// @param bones  names, matched exactly
    /// @param user   named in errors: who asks for these bones
    /// @return [triangles] 1 where marked
    /// @throws InvalidInput for a body without bones, an unknown name (with the nearest names there are), and
    ///         a bone that no face follows.
    virtual std::vector<unsigned char> faces_on_bones(const std::vector<std::string>& bones,
                                                      const std::string& user) const;

    /// What its vertices follow: skin().posed(v, bones) is where one of them is.
    virtual SkinView skin() const = 0;
    virtual int bone_count() const = 0;

    /// Where the bones are in a pose, in metres, Y up, carried through `world_from_avatar`. Reuses scratch:
    /// one thread at a time.
    /// @param bones  [bone_count()] out: world_from_mesh
    virtual void pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones) = 0;

    /// All vertices as bones have them: one call of stage "avatars/skin".
    /// @param bones  [bone_count()] world_from_mesh
    /// @param out    [vertices] [m]
    void skin_vertices(View<const Affine> bones, View<Vec3> out) const;

    /// Vertex positions of a pose: pose_bones() and skin_vertices().
    /// @param out  [vertices] [m]
    void pose(const PoseAt& at, const Affine& world_from_avatar, View<Vec3> out);

protected:
    Avatar(std::string source, std::vector<Triangle> triangles, int vertex_count, std::vector<ClipName> clips)
        : source_(std::move(source)), triangles_(std::move(triangles)), vertex_count_(vertex_count),
          clips_(std::move(clips))
    {
    }

private:
    std::string source_;
    std::vector<Triangle> triangles_;
    int vertex_count_;
    std::vector<ClipName> clips_;
};

} // namespace toile
