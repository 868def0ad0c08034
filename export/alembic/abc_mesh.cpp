#include "export/alembic/abc_mesh.h"

#include <algorithm>
#include <utility>

#include "export/archive/face_groups.h"
#include "export/archive/names.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

using Kind = AbcProperty::Kind;

/// Of positions and all that moves with them.
constexpr int kFrames = 1;

std::string schema(const std::string& type) { return "schema=AbcGeom_" + type; }

/// Metadata of an object whose schema is in one of its compounds.
std::string schema_of_object(const std::string& type, const std::string& compound)
{
    return schema(type) + ";schemaObjTitle=AbcGeom_" + type + ":" + compound;
}

AbcProperty vectors(const std::string& name, const std::string& metadata)
{
    return AbcProperty({name, Kind::Array, AbcType::Float32, 3, metadata, kFrames});
}

AbcProperty integers(const std::string& name) { return AbcProperty({name, Kind::Array, AbcType::Int32, 1}); }

AbcProperty corner_indices() { return AbcProperty({".indices", Kind::Array, AbcType::Uint32, 1}); }

/// Metadata is a list of key=value; and some values are lists.
std::string without_separators(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ';' || c == '=' || c == ','; }, '_');
    return text;
}

/// Metadata of one number for each vertex (vtx) or face (uni).
std::string numbers_of(const std::string& scope, const std::string& type)
{
    return "arrayExtent=1;geoScope=" + scope +
           ";interpretation=;isGeomParam=true;podExtent=1;podName=" + type;
}

/// Indices at corners, in the order of clockwise faces.
template <typename T>
std::string bytes_of_corners(const std::vector<std::vector<int>>& polygons)
{
    std::string bytes;
    for (const std::vector<int>& corners : polygons)
        for (auto at = corners.rbegin(); at != corners.rend(); ++at)
            append(bytes, T(*at));
    return bytes;
}

/// Values at corners, by indices.
AbcCompound at_corners(const std::string& name, const std::string& interpretation, int extent,
                       const AbcProperty& values, const AbcProperty& indices)
{
    return {name,
            "arrayExtent=1;geoScope=fvr;interpretation=" + interpretation +
                ";isGeomParam=true;podExtent=" + std::to_string(extent) + ";podName=float32_t",
            {&values, &indices}};
}

} // namespace

OgawaNode add_object(OgawaFile& file, OgawaNode properties, const std::vector<AbcObject>& children)
{
    std::vector<OgawaNode> nodes{properties};
    std::string headers;
    for (const AbcObject& child : children) {
        nodes.push_back(child.group);
        append(headers, std::uint32_t(child.name.size()));
        headers += child.name;
        append(headers, std::uint8_t{0xff}); // metadata follows
        append(headers, std::uint32_t(child.metadata.size()));
        headers += child.metadata;
    }
    headers.append(32, '\0'); // hashes of properties and children, which may be left out
    nodes.push_back(file.add_data(headers));
    return file.add_group(nodes);
}

AbcObject add_transform(OgawaFile& file, const std::string& name, const std::vector<AbcObject>& children)
{
    const AbcCompound transform{".xform", schema("Xform_v3")};
    std::string metadata = schema_of_object("Xform_v3", ".xform");
    if (name != clean_name(name))
        metadata += ";toile_name=" + without_separators(name);
    return {clean_name(name), metadata,
            add_object(file, AbcCompound{"", "", {}, {transform}}.add_group(file), children)};
}

AbcMesh::AbcMesh(OgawaFile& file, const CacheMesh& mesh, const Options& options)
    : name_(mesh.name),
      bounds_({".selfBnds", Kind::Scalar, AbcType::Float64, 6, "interpretation=box", kFrames}),
      positions_(vectors("P", "geoScope=vtx;interpretation=point")), indices_(integers(".faceIndices")),
      counts_(integers(".faceCounts")),
      texture_({".vals", Kind::Array, AbcType::Float32, 2, "geoScope=fvr;interpretation=vector"}),
      texture_indices_(corner_indices()), normals_(vectors(".vals", "geoScope=fvr;interpretation=normal")),
      normal_indices_(corner_indices())
{
    const ObjMesh& faces = mesh.faces;
    std::string counts;
    for (const std::vector<int>& polygon : faces.polygons)
        append(counts, std::int32_t(polygon.size()));
    indices_.add_sample(file, bytes_of_corners<std::int32_t>(faces.polygons));
    counts_.add_sample(file, counts);
    if (options.velocities)
        velocities_ = vectors(".velocities", "geoScope=vtx;interpretation=vector");
    if (options.normals) {
        corner_normals_.emplace(faces);
        normal_indices_.add_sample(file, bytes_of_corners<std::uint32_t>(corner_normals_->indices()));
    }
    if (!faces.polygon_uvs.empty())
        add_texture(file, faces);
    add_face_sets(file, faces);
    for (const std::string& name : mesh.attributes)
        attributes_.push_back(
            AbcProperty({name, Kind::Array, AbcType::Float32, 1, numbers_of("vtx", "float32_t"), kFrames}));
    if (!mesh.panels.of_face.empty())
        add_panels(file, mesh.panels);
}

void AbcMesh::add_panels(OgawaFile& file, const FacePanels& panels)
{
    std::string names, numbers;
    for (const std::string& name : panels.names)
        names += (names.empty() ? "" : ",") + without_separators(name);
    for (const int panel : panels.of_face)
        append(numbers, std::int32_t(panel));
    panels_ = AbcProperty({kPanelAttribute, Kind::Array, AbcType::Int32, 1,
                           numbers_of("uni", "int32_t") + ";toile_names=" + names});
    panels_->add_sample(file, numbers);
}

void AbcMesh::add_texture(OgawaFile& file, const ObjMesh& faces)
{
    std::string values;
    for (const Vec2& at : faces.texture_coordinates)
        for (int axis = 0; axis < 2; ++axis)
            append(values, float(at[axis]));
    texture_.add_sample(file, values);
    texture_indices_.add_sample(file, bytes_of_corners<std::uint32_t>(faces.polygon_uvs));
}

void AbcMesh::add_face_sets(OgawaFile& file, const ObjMesh& faces)
{
    for (const FaceGroup& group : face_groups(faces)) {
        std::string bytes;
        for (const int polygon : group.polygons)
            append(bytes, std::int32_t(polygon));
        face_sets_.push_back({group.clean_name, integers(".faces")});
        face_sets_.back().faces.add_sample(file, bytes);
    }
}

void AbcMesh::add_sample(OgawaFile& file, const MovingSample& sample)
{
    const View<const Vec3> x = sample.positions;
    positions_.add_sample(file, bytes_of(x));
    if (velocities_)
        velocities_->add_sample(file, bytes_of(sample.velocities));
    if (corner_normals_)
        normals_.add_sample(file, bytes_of(corner_normals_->at(x)));
    for (size_t k = 0; k < attributes_.size(); ++k)
        attributes_[k].add_sample(file, bytes_of(sample.attributes.subview(int(k) * x.size(), x.size())));
    const Bounds box = bounds(x);
    std::string bytes;
    for (const Vec3& corner : {box.lower, box.upper})
        for (int axis = 0; axis < 3; ++axis)
            append(bytes, corner[axis]);
    bounds_.add_sample(file, bytes);
}

AbcCompound AbcMesh::geometry() const
{
    AbcCompound geometry{".geom",
                         schema("PolyMesh_v1") + ";schemaBaseType=AbcGeom_GeomBase_v1",
                         {&bounds_, &positions_, &indices_, &counts_}};
    if (velocities_)
        geometry.properties.push_back(&*velocities_);
    if (!texture_.is_empty())
        geometry.compounds.push_back(at_corners("uv", "vector", 2, texture_, texture_indices_));
    if (corner_normals_)
        geometry.compounds.push_back(at_corners("N", "normal", 3, normals_, normal_indices_));
    AbcCompound others{".arbGeomParams", ""};
    for (const AbcProperty& attribute : attributes_)
        others.properties.push_back(&attribute);
    if (panels_)
        others.properties.push_back(&*panels_);
    if (!others.properties.empty())
        geometry.compounds.push_back(std::move(others));
    return geometry;
}

AbcObject AbcMesh::add_object(OgawaFile& file) const
{
    std::vector<AbcObject> sets;
    for (const FaceSet& set : face_sets_) { // its bounds, which Blender needs, may be those of the mesh
        const AbcCompound faces{
            ".faceset", schema("FaceSet_v1") + ";schemaBaseType=AbcGeom_GeomBase_v1", {&bounds_, &set.faces}};
        const OgawaNode properties = AbcCompound{"", "", {}, {faces}}.add_group(file);
        sets.push_back({set.name, schema_of_object("FaceSet_v1", ".faceset"),
                        exports::add_object(file, properties, {})});
    }
    const OgawaNode properties = AbcCompound{"", "", {}, {geometry()}}.add_group(file);
    const AbcObject mesh{clean_name(name_) + "Shape", schema_of_object("PolyMesh_v1", ".geom"),
                         exports::add_object(file, properties, sets)};
    return add_transform(file, name_, {mesh});
}

} // namespace toile::exports
