#pragma once

#include <map>
#include <string>
#include <vector>

#include "avatars/model/skeletal_motion.h"
#include "avatars/model/skinned_avatar.h"

namespace toile::avatars {

/// Distance below which two vertices of a file are coincident, over the diagonal of the mesh [-]. Single
/// precision files repeat seam positions exactly; real features are a thousand times farther apart.
inline constexpr double kSeamDistance = 1e-6;

/// Names without repetition: the second "arm" becomes "arm#2", or the next number that no name has.
std::vector<std::string> distinct_names(std::vector<std::string> names);

/// Checks the keys of a track: finite times that do not descend, finite values, rotations of length above 0.
/// @param place  of the track in its file, begins the message
/// @throws InvalidInput naming the first key that is wrong.
void require_usable(const Track<Vec3>& track, const std::string& place);
void require_usable(const Track<Eigen::Quaterniond>& track, const std::string& place);
void require_usable(const Track<double>& track, const std::string& place);

/// A triangle of a finished model, as the importer added it. What differs on both sides of a seam, such as
/// texture coordinates, is found by it.
struct AddedTriangle {
    int index = 0;    ///< among those added
    Triangle corners; ///< vertices as they were added; corner k is corner k of the finished triangle
};

/// Assembles a RiggedModel from the parts that an importer finds. The importer adds joints and vertices in
/// the file's order, the builder completes them.
class ModelBuilder {
public:
    /// @param source  the file, named in errors
    explicit ModelBuilder(std::string source) : source_(std::move(source)) {}

    Skeleton& skeleton() { return model_.skeleton; }
    /// For vertices with their influences and offsets, and triangles. Weights need no particular sum.
    SkinnedMesh& mesh() { return model_.mesh; }
    void add_clip(Clip clip) { model_.clips.push_back(std::move(clip)); }

    /// Index of the bone. Equal bones (from several meshes of a skin) are stored once, so that their seams
    /// weld.
    /// @throws InvalidInput for a matrix that is not finite.
    int add_bone(const Bone& bone);

    /// Scales weights to sum 1, turns the triangles that the rest pose mirrors, and welds seams.
    /// @throws InvalidInput for a model without surface, a vertex without weight, a number that is not
    /// finite.
    RiggedModel finish();

    /// [triangles of finish()]
    const std::vector<AddedTriangle>& added_triangles() const { return added_triangles_; }

    /// Joints and clips alone, of a file that needs no surface.
    SkeletalMotion motion();

private:
    void require_surface() const;
    void turn_mirrored_triangles();
    void weld();

    std::string source_;
    RiggedModel model_;
    std::vector<AddedTriangle> added_triangles_;
    std::map<std::vector<double>, int> index_of_bone_; ///< by joint and matrix
};

} // namespace toile::avatars
