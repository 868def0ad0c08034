#pragma once

#include <optional>
#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "export/alembic/abc_property.h"
#include "export/archive/frame_velocities.h"
#include "export/cache_layout.h"
#include "export/corner_normals.h"

namespace toile::exports {

/// Node of the objects of an Alembic archive, in a list of its parent.
struct AbcObject {
    std::string name, metadata;
    OgawaNode group;
};

/// Group of an object: its properties, its children and their names.
OgawaNode add_object(OgawaFile& file, OgawaNode properties, const std::vector<AbcObject>& children);

/// A transform that changes nothing, above its children.
/// @param name  as the user gave it; kept as metadata if it has to be cleaned
AbcObject add_transform(OgawaFile& file, const std::string& name, const std::vector<AbcObject>& children);

/// A mesh of an Alembic archive that moves with constant topology: a transform /NAME, for programs that show
/// no mesh without one, above the mesh NAMEShape, with a face set for each group, and attributes and panels
/// among the .arbGeomParams. Faces are clockwise in Alembic, and so is all that is stored per corner.
class AbcMesh {
public:
    struct Options {
        bool velocities = true;
        bool normals = false; ///< at corners: CornerNormals
    };

    /// Writes the faces.
    AbcMesh(OgawaFile& file, const CacheMesh& mesh, const Options& options);

    void add_sample(OgawaFile& file, const MovingSample& sample);

    /// Writes the nodes of all samples so far.
    AbcObject add_object(OgawaFile& file) const;

private:
    struct FaceSet {
        std::string name;
        AbcProperty faces;
    };

    void add_texture(OgawaFile& file, const ObjMesh& faces);
    void add_face_sets(OgawaFile& file, const ObjMesh& faces);
    void add_panels(OgawaFile& file, const FacePanels& panels);
    AbcCompound geometry() const;

    std::string name_; ///< as given
    AbcProperty bounds_, positions_, indices_, counts_, texture_, texture_indices_;
    std::optional<AbcProperty> velocities_;
    std::optional<CornerNormals> corner_normals_;
    AbcProperty normals_, normal_indices_; ///< empty without the former
    std::vector<FaceSet> face_sets_;
    std::vector<AbcProperty> attributes_; ///< of the vertices
    std::optional<AbcProperty> panels_;
};

} // namespace toile::exports
