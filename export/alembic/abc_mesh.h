#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"
#include "export/alembic/abc_property.h"

namespace toile::exports {

/// Node of the objects of an Alembic archive, in a list of its parent.
struct AbcObject {
    std::string name, metadata;
    OgawaNode group;
};

/// Group of an object: its properties, its children and their names.
OgawaNode add_object(OgawaFile& file, OgawaNode properties, const std::vector<AbcObject>& children);

/// Name as programs accept it: letters, digits and underscores, none of the digits first.
std::string abc_name(const std::string& name);

/// A mesh of an Alembic archive that moves with constant topology: a transform /NAME, for programs that show
/// no mesh without one, above the mesh NAMEShape, with a face set for each group. Faces are clockwise in
/// Alembic, and so is all that is stored per corner.
class AbcMesh {
public:
    /// Writes the faces.
    /// @param faces  polygons of `vertex_count` vertices, and texture coordinates if it has them
    /// @throws InvalidInput for two groups of one name
    AbcMesh(OgawaFile& file, const std::string& name, const ObjMesh& faces);

    /// Appends a sample. @param x, v  [vertices] [m], [m/s]
    void add_sample(OgawaFile& file, View<const Vec3> x, View<const Vec3> v);

    /// Writes the nodes of all samples so far.
    AbcObject add_object(OgawaFile& file) const;

private:
    struct FaceSet {
        std::string name;
        AbcProperty faces;
    };

    void add_texture(OgawaFile& file, const ObjMesh& faces);
    void add_face_sets(OgawaFile& file, const ObjMesh& faces);
    AbcCompound geometry() const;

    std::string name_, given_name_;
    AbcProperty bounds_, positions_, velocities_, indices_, counts_, texture_, texture_indices_;
    std::vector<FaceSet> face_sets_;
};

} // namespace toile::exports
