#include "export/usd/usd_mesh.h"

#include <algorithm>
#include <utility>

#include "core/mesh/triangle_mesh.h"
#include "export/archive/names.h"

namespace toile::exports {

namespace {

void append(std::vector<float>& numbers, const Vec3& x)
{
    for (int axis = 0; axis < 3; ++axis)
        numbers.push_back(float(x[axis]));
}

std::vector<float> floats_of(View<const Vec3> vectors)
{
    std::vector<float> numbers;
    numbers.reserve(3 * size_t(vectors.size()));
    for (const Vec3& x : vectors)
        append(numbers, x);
    return numbers;
}

std::vector<int> joined(const std::vector<std::vector<int>>& lists)
{
    std::vector<int> all;
    for (const std::vector<int>& list : lists)
        all.insert(all.end(), list.begin(), list.end());
    return all;
}

constexpr const char* kAtCorners = " (interpolation = \"faceVarying\")";
constexpr const char* kAtVertices = " (interpolation = \"vertex\")";

} // namespace

UsdMesh::UsdMesh(const CacheMesh& mesh, const Options& options)
    : name_(clean_name(mesh.name) + "Shape"), faces_(mesh.faces), groups_(face_groups(mesh.faces)),
      panels_(mesh.panels), has_velocities_(options.velocities)
{
    tracks_.emplace_back("float3[] extent", 3);
    tracks_.emplace_back("point3f[] points", 3);
    if (has_velocities_)
        tracks_.emplace_back("vector3f[] velocities", 3);
    if (options.normals) {
        corner_normals_.emplace(mesh.faces);
        tracks_.emplace_back("normal3f[] normals", 3, kAtCorners);
    }
    for (const std::string& name : mesh.attributes)
        tracks_.emplace_back("float[] primvars:" + name, 1, kAtVertices);
}

void UsdMesh::add_sample(const MovingSample& sample)
{
    const View<const Vec3> x = sample.positions;
    const Bounds box = bounds(x);
    auto track = tracks_.begin();
    (track++)->add(floats_of(std::vector<Vec3>{box.lower, box.upper}));
    (track++)->add(floats_of(x));
    if (has_velocities_)
        (track++)->add(floats_of(sample.velocities));
    if (corner_normals_)
        (track++)->add(normals_at(x));
    for (int first = 0; first < sample.attributes.size(); first += x.size()) {
        const View<const float> numbers = sample.attributes.subview(first, x.size());
        (track++)->add({numbers.begin(), numbers.end()});
    }
}

std::vector<float> UsdMesh::normals_at(View<const Vec3> x) const
{
    const std::vector<Vec3> normals = corner_normals_->at(x);
    std::vector<float> at_corners;
    for (const std::vector<int>& indices : corner_normals_->indices())
        for (const int index : indices)
            append(at_corners, normals[size_t(index)]);
    return at_corners;
}

void UsdMesh::drop_all_but_last()
{
    for (UsdTrack& track : tracks_)
        track.drop_all_but_last();
}

void UsdMesh::write(UsdFile& file, UsdLayer layer, const std::string& parent, const std::string& indent,
                    const std::vector<double>& times) const
{
    const bool has_faces = layer == UsdLayer::Whole || layer == UsdLayer::Root;
    const std::string inner = indent + "    ";
    file << indent << (has_faces ? "def Mesh \"" : "over \"") << name_ << "\"\n" << indent << "{\n";
    if (has_faces)
        write_faces(file, inner);
    for (const UsdTrack& track : tracks_) {
        if (layer == UsdLayer::Whole)
            track.write(file, inner, times);
        else if (layer == UsdLayer::Clip)
            track.write_all(file, inner, times);
        else
            track.declare(file, inner);
    }
    if (has_faces)
        write_groups(file, parent, inner);
    file << indent << "}\n";
    if (has_faces)
        write_materials(file, indent);
}

void UsdMesh::write_faces(UsdFile& file, const std::string& indent) const
{
    std::vector<int> counts;
    for (const std::vector<int>& polygon : faces_.polygons)
        counts.push_back(int(polygon.size()));
    file << indent << "int[] faceVertexCounts = ";
    file.append(counts);
    file << "\n" << indent << "int[] faceVertexIndices = ";
    file.append(joined(faces_.polygons));
    file << "\n" << indent << "uniform token orientation = \"rightHanded\"\n";
    file << indent << "uniform token subdivisionScheme = \"none\"\n";
    write_panels(file, indent);
    if (faces_.polygon_uvs.empty())
        return;
    std::vector<float> texture;
    for (const Vec2& at : faces_.texture_coordinates) {
        texture.push_back(float(at.x()));
        texture.push_back(float(at.y()));
    }
    file << indent << "texCoord2f[] primvars:st = ";
    file.append(texture.data(), texture.size(), 2);
    file << kAtCorners << "\n" << indent << "int[] primvars:st:indices = ";
    file.append(joined(faces_.polygon_uvs));
    file << "\n";
}

void UsdMesh::write_panels(UsdFile& file, const std::string& indent) const
{
    if (panels_.of_face.empty())
        return;
    file << indent << "int[] primvars:" << kPanelAttribute << " = ";
    file.append(panels_.of_face);
    file << " (\n" << indent << "    customData = {\n" << indent << "        string[] names = [";
    for (size_t k = 0; k < panels_.names.size(); ++k)
        file << (k == 0 ? "" : ", ") << usd_quoted(panels_.names[k]);
    file << "]\n" << indent << "    }\n" << indent << "    interpolation = \"uniform\"\n" << indent << ")\n";
}

void UsdMesh::write_groups(UsdFile& file, const std::string& parent, const std::string& indent) const
{
    if (groups_.empty())
        return;
    file << indent << "uniform token subsetFamily:materialBind:familyType = \"nonOverlapping\"\n";
    for (const FaceGroup& group : groups_) {
        file << "\n" << indent << "def GeomSubset \"" << group.clean_name << "\" (\n";
        if (group.name != group.clean_name)
            file << indent << "    displayName = " << usd_quoted(group.name) << "\n";
        file << indent << "    prepend apiSchemas = [\"MaterialBindingAPI\"]\n";
        file << indent << ")\n" << indent << "{\n";
        file << indent << "    uniform token elementType = \"face\"\n";
        file << indent << "    uniform token familyName = \"materialBind\"\n";
        file << indent << "    int[] indices = ";
        file.append(group.polygons);
        file << "\n"
             << indent << "    rel material:binding = <" << parent << "/" << material_of(group) << ">\n";
        file << indent << "}\n";
    }
}

std::string UsdMesh::material_of(const FaceGroup& group) const
{
    std::string name = group.clean_name;
    const auto is_of_other = [&](const FaceGroup& other) {
        return other.clean_name == name && &other != &group;
    };
    while (name == name_ || std::any_of(groups_.begin(), groups_.end(), is_of_other))
        name += "_";
    return name;
}

void UsdMesh::write_materials(UsdFile& file, const std::string& indent) const
{
    for (const FaceGroup& group : groups_) {
        file << "\n" << indent << "def Material \"" << material_of(group) << "\"";
        if (group.name != group.clean_name)
            file << " (\n"
                 << indent << "    displayName = " << usd_quoted(group.name) << "\n"
                 << indent << ")";
        file << "\n" << indent << "{\n" << indent << "}\n";
    }
}

} // namespace toile::exports
