#include "export/alembic/abc_mesh.h"

#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "core/base/error.h"
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

std::string bytes_of(View<const Vec3> vectors)
{
    std::string bytes;
    bytes.reserve(12 * size_t(vectors.size()));
    for (const Vec3& at : vectors)
        for (int axis = 0; axis < 3; ++axis)
            append(bytes, float(at[axis]));
    return bytes;
}

/// Metadata is a list of key=value;
std::string without_separators(std::string text)
{
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == ';' || c == '='; }, '_');
    return text;
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

std::string abc_name(const std::string& name)
{
    std::string clean = name;
    for (char& c : clean)
        if (!std::isalnum(static_cast<unsigned char>(c)))
            c = '_';
    if (clean.empty() || std::isdigit(static_cast<unsigned char>(clean.front())))
        clean.insert(0, "_");
    return clean;
}

AbcMesh::AbcMesh(OgawaFile& file, const std::string& name, const ObjMesh& faces)
    : name_(abc_name(name)), given_name_(name),
      bounds_({".selfBnds", Kind::Scalar, AbcType::Float64, 6, "interpretation=box", kFrames}),
      positions_(vectors("P", "geoScope=vtx;interpretation=point")),
      velocities_(vectors(".velocities", "geoScope=vtx;interpretation=vector")),
      indices_(integers(".faceIndices")), counts_(integers(".faceCounts")),
      texture_({".vals", Kind::Array, AbcType::Float32, 2, "geoScope=fvr;interpretation=vector"}),
      texture_indices_({".indices", Kind::Array, AbcType::Uint32, 1})
{
    std::string indices, counts;
    for (const std::vector<int>& polygon : faces.polygons) {
        append(counts, std::int32_t(polygon.size()));
        for (auto v = polygon.rbegin(); v != polygon.rend(); ++v)
            append(indices, std::int32_t(*v));
    }
    indices_.add_sample(file, indices);
    counts_.add_sample(file, counts);
    if (!faces.polygon_uvs.empty())
        add_texture(file, faces);
    add_face_sets(file, faces);
}

void AbcMesh::add_texture(OgawaFile& file, const ObjMesh& faces)
{
    std::string values, indices;
    for (const Vec2& at : faces.texture_coordinates)
        for (int axis = 0; axis < 2; ++axis)
            append(values, float(at[axis]));
    for (const std::vector<int>& corners : faces.polygon_uvs)
        for (auto at = corners.rbegin(); at != corners.rend(); ++at)
            append(indices, std::uint32_t(*at));
    texture_.add_sample(file, values);
    texture_indices_.add_sample(file, indices);
}

/// A group may begin several times.
void AbcMesh::add_face_sets(OgawaFile& file, const ObjMesh& faces)
{
    std::vector<std::pair<std::string, std::string>> sets; // name, bytes
    std::map<std::string, size_t> set_of;
    for (size_t g = 0; g < faces.groups.size(); ++g) {
        const ObjGroup& group = faces.groups[g];
        const int end =
            g + 1 < faces.groups.size() ? faces.groups[g + 1].first_polygon : int(faces.polygons.size());
        if (group.name.empty() || group.first_polygon == end)
            continue;
        const auto [at, is_new] = set_of.try_emplace(group.name, sets.size());
        if (is_new)
            sets.emplace_back(group.name, "");
        for (int polygon = group.first_polygon; polygon < end; ++polygon)
            append(sets[at->second].second, std::int32_t(polygon));
    }
    std::set<std::string> taken;
    for (const auto& [name, bytes] : sets) {
        std::string clean = abc_name(name);
        for (int k = 2; !taken.insert(clean).second; ++k)
            clean = abc_name(name) + "_" + std::to_string(k);
        face_sets_.push_back({clean, integers(".faces")});
        face_sets_.back().faces.add_sample(file, bytes);
    }
}

void AbcMesh::add_sample(OgawaFile& file, View<const Vec3> x, View<const Vec3> v)
{
    positions_.add_sample(file, bytes_of(x));
    velocities_.add_sample(file, bytes_of(v));
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
                         {&bounds_, &positions_, &velocities_, &indices_, &counts_}};
    if (!texture_.is_empty())
        geometry.compounds.push_back({"uv",
                                      "arrayExtent=1;geoScope=fvr;interpretation=vector;isGeomParam=true;"
                                      "podExtent=2;podName=float32_t",
                                      {&texture_, &texture_indices_}});
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
    const AbcObject mesh{name_ + "Shape", schema_of_object("PolyMesh_v1", ".geom"),
                         exports::add_object(file, properties, sets)};
    const AbcCompound transform{".xform", schema("Xform_v3")};
    std::string metadata = schema_of_object("Xform_v3", ".xform");
    if (given_name_ != name_)
        metadata += ";toile_name=" + without_separators(given_name_);
    return {name_, metadata,
            exports::add_object(file, AbcCompound{"", "", {}, {transform}}.add_group(file), {mesh})};
}

} // namespace toile::exports
