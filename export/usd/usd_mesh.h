#pragma once

#include <optional>
#include <string>
#include <vector>

#include "export/archive/face_groups.h"
#include "export/archive/frame_velocities.h"
#include "export/cache_layout.h"
#include "export/corner_normals.h"
#include "export/usd/usd_track.h"

namespace toile::exports {

/// Layers that hold a stage together or in parts.
enum class UsdLayer {
    Whole,    ///< everything
    Root,     ///< all but samples, which are in clips
    Clip,     ///< samples
    Manifest, ///< names of attributes that have samples in clips
};

/// A mesh of a USD stage that moves with constant topology, and its latest samples: polygons, texture
/// coordinates (primvars:st), groups as subsets of the family materialBind, velocities, normals and extent;
/// attributes and panels as primvars.
class UsdMesh {
public:
    struct Options {
        bool velocities = true;
        bool normals = false; ///< at corners: CornerNormals
    };

    UsdMesh(const CacheMesh& mesh, const Options& options);

    void add_sample(const MovingSample& sample);
    void drop_all_but_last();

    /// Writes the prim NAMEShape, and beside it a material for each group, from which Blender makes a slot.
    /// @param parent  path of the transform that they lie in
    /// @param times   [samples] time codes
    void write(UsdFile& file, UsdLayer layer, const std::string& parent, const std::string& indent,
               const std::vector<double>& times) const;

private:
    /// [corners x 3]
    std::vector<float> normals_at(View<const Vec3> x) const;
    void write_faces(UsdFile& file, const std::string& indent) const;
    void write_panels(UsdFile& file, const std::string& indent) const;
    void write_groups(UsdFile& file, const std::string& parent, const std::string& indent) const;
    void write_materials(UsdFile& file, const std::string& indent) const;
    /// Of the material of a group: like the group's, but not like the mesh's.
    std::string material_of(const FaceGroup& group) const;

    std::string name_;
    ObjMesh faces_; ///< without positions
    std::vector<FaceGroup> groups_;
    std::optional<CornerNormals> corner_normals_;
    FacePanels panels_; ///< empty: none
    bool has_velocities_;
    std::vector<UsdTrack> tracks_; ///< extent, points, velocities and normals if stored, attributes
};

} // namespace toile::exports
