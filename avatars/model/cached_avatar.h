#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "avatars/model/avatar.h"

namespace toile::avatars {

/// A surface whose positions are stored sample by sample.
struct GeometryCache {
    std::vector<Triangle> triangles;
    int vertex_count = 0;
    std::vector<double> times; ///< [samples] [s] strictly increasing, at least one

    /// Reads the positions of a sample, [vertices] in the units and axes of the file.
    std::function<std::vector<Vec3>(int sample)> positions;
    Affine metres_from_file = identity_affine();

    bool turns_bones = true; ///< bones turn with the surface, as insets of skin need; else they stay parallel
};

/// A body that was animated elsewhere: its vertices are where a cache has them.
///
///   x_v(t) = (1 - u) x_v^k + u x_v^(k+1),   u = (t - t^k) / (t^(k+1) - t^k)
///
/// The only clip, "cache", begins at the time of sample 0 and ends with the last; sample 0 is the bind pose.
/// A cache of one sample has no clip. Samples are read when they are needed, and the last kSamples are kept.
///
/// Every vertex follows a bone of its own, which is at the vertex and turns with the surface around it. All
/// that is done with skins works: insets of skin, bounds of motion, posing on a GPU.
class CachedAvatar final : public Avatar {
public:
    static constexpr const char* kClip = "cache";
    static constexpr int kSamples = 8; ///< two around the present, and those that insets look ahead to

    CachedAvatar(std::string source, GeometryCache cache);

    SkinView skin() const override { return {origins_, first_, influences_}; }
    int bone_count() const override { return vertex_count(); }

    /// @throws InvalidInput naming the sample and the vertex for a position that is not finite or out of
    /// range
    void pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones) override;

private:
    using Positions = std::vector<Vec3>;
    struct Sample {
        int index;
        std::shared_ptr<const Positions> x; ///< [vertices] [m]
    };

    std::shared_ptr<const Positions> sample(int index);
    Positions read(int index) const;
    Positions at(const PoseAt& at);
    void list_neighbours();
    void choose_anchors();
    std::vector<Mat3> frames(const Positions& x) const;
    std::vector<Mat3> turns(const Positions& x) const;

    GeometryCache cache_;
    std::vector<Vec3> origins_; ///< [vertices] zeros
    std::vector<int> first_;    ///< [vertices + 1] 0, 1, 2, ...
    std::vector<Influence> influences_;
    std::vector<int> first_neighbour_; ///< [vertices + 1] start of a vertex's neighbours
    std::vector<int> neighbours_;      ///< [first_neighbour_.back()] at the other ends of its edges
    std::vector<int> anchor_;       ///< [vertices] neighbour whose edge is most tangential at rest; -1: none
    std::vector<Sample> samples_;   ///< used last is last
    std::vector<Mat3> rest_frames_; ///< [vertices] in sample 0
};

} // namespace toile::avatars
