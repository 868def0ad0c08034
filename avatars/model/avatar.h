#pragma once

#include <string>
#include <vector>

#include "avatars/model/skeleton.h"
#include "avatars/model/skinning_kernels.h"

namespace toile::avatars {

/// Pose of an avatar in its motion. pose_at() in motion.h maps simulation time to clip time.
struct PoseAt {
    int clip = -1;            ///< index in Avatar::clips(), or -1 for the bind pose
    double time = 0.0;        ///< [s] of the clip, 0 to its duration
    double bind_weight = 0.0; ///< [-] blend weight: 0 shows the clip, 1 the bind pose
    int cycles = 0;           ///< full clips completed; moves the avatar by as many root travels

    bool operator==(const PoseAt&) const = default;
};

/// A body in the simulation: fixed triangles, with vertices and bones available at any clip time. The vertex
/// order is that of the triangles and never changes.
class Avatar {
public:
    struct ClipName {
        std::string name;
        double duration; ///< [s]
    };

    virtual ~Avatar() = default;
    Avatar(const Avatar&) = delete;
    Avatar& operator=(const Avatar&) = delete;

    /// Origin for messages: a file name, or "mannequin".
    const std::string& source() const { return source_; }
    const std::vector<Triangle>& triangles() const { return triangles_; }
    int vertex_count() const { return vertex_count_; }

    /// Turns the triangles so that the outside of closed pieces is outwards in the bind pose (face_outwards).
    void face_outwards();
    /// Number of triangles that face_outwards() has turned.
    int turned_count() const { return turned_count_; }

    /// Available clips. Empty: the avatar has only one pose.
    const std::vector<ClipName>& clips() const { return clips_; }
    bool is_static() const { return clips_.empty(); }

    /// Index in clips().
    /// @throws InvalidInput naming the nearest clip and listing all.
    int clip_index(const std::string& name) const;

    /// Marks the faces that follow one of these bones, or one of their descendants in the skeleton. A face
    /// follows the bone with the largest skin weight over its three corners; on a tie, the first in the
    /// skeleton.
    /// @param bones  names, matched exactly
    /// @param user   named in errors: the part of a scene that names these bones
    /// @return [triangles] 1 if marked
    /// @throws InvalidInput for a body without bones, an unknown name (with the nearest existing names),
    ///         and a bone that no face follows.
    virtual std::vector<unsigned char> faces_on_bones(const std::vector<std::string>& bones,
                                                      const std::string& user) const;

    /// Name of the bone with the largest skin weight at a vertex; empty for a body without bones.
    virtual std::string bone_at(int /*vertex*/) const { return {}; }

    /// Skin weights of the vertices: skin().posed(v, bones) is the position of vertex v.
    virtual SkinView skin() const = 0;
    /// Number of maps that make a pose: one per bone, then one per blend shape.
    virtual int bone_count() const = 0;

    /// Computes the bones of a pose, in metres, Y up, transformed by `world_from_avatar`. Reuses scratch: one
    /// thread at a time.
    /// @param bones  [bone_count()] out: world_from_mesh, then the blend shapes' maps, see SkinView::posed
    virtual void pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones) = 0;

    /// Computes all vertices from the bones: one call of stage "avatars/skin".
    /// @param bones  [bone_count()] from pose_bones()
    /// @param out    [vertices] [m]
    void skin_vertices(View<const Affine> bones, View<Vec3> out) const { skin_vertices(skin(), bones, out); }
    /// Likewise, of the avatar's skin with insets.
    static void skin_vertices(const SkinView& skin, View<const Affine> bones, View<Vec3> out);

    /// Computes the vertex positions of a pose: pose_bones() and skin_vertices().
    /// @param out  [vertices] [m]
    void pose(const PoseAt& at, const Affine& world_from_avatar, View<Vec3> out);

protected:
    void add_clip_name(ClipName clip) { clips_.push_back(std::move(clip)); }

    Avatar(std::string source, std::vector<Triangle> triangles, int vertex_count, std::vector<ClipName> clips)
        : source_(std::move(source)), triangles_(std::move(triangles)), vertex_count_(vertex_count),
          clips_(std::move(clips))
    {
    }

private:
    std::string source_;
    std::vector<Triangle> triangles_;
    int vertex_count_;
    int turned_count_ = 0;
    std::vector<ClipName> clips_;
};

} // namespace toile::avatars
