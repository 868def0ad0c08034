#include "avatars/import/gltf_meshes.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/long_work.h"

namespace toile::avatars {

namespace {

constexpr AccessorRule kPosition{"VEC3", kFloat | kByte | kUnsignedByte | kShort | kUnsignedShort};
constexpr AccessorRule kJoints{"VEC4", kUnsignedByte | kUnsignedShort};
constexpr AccessorRule kWeights{"VEC4", kFloat | kUnsignedByte | kUnsignedShort};
constexpr AccessorRule kIndices{"SCALAR", kUnsignedByte | kUnsignedShort | kUnsignedInt};
constexpr AccessorRule kMatrices{"MAT4", kFloat};

enum PrimitiveMode : int { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

PrimitiveMode mode_of(const GltfValue& primitive)
{
    const std::optional<GltfValue> mode = primitive.find("mode");
    return mode ? PrimitiveMode(mode->whole(0, kTriangleFan)) : kTriangles;
}

/// Triangles of corners in a row.        [glTF 2.0, section 3.7.2.1]
std::vector<Triangle> triangles_of(const std::vector<int>& corners, PrimitiveMode mode)
{
    std::vector<Triangle> triangles;
    const size_t count = corners.size();
    for (size_t i = 0; i + 2 < count; i += mode == kTriangles ? 3 : 1) {
        const size_t odd = i % 2;
        if (mode == kTriangleFan)
            triangles.emplace_back(corners[i + 1], corners[i + 2], corners[0]);
        else if (mode == kTriangleStrip)
            triangles.emplace_back(corners[i], corners[i + 1 + odd], corners[i + 2 - odd]);
        else
            triangles.emplace_back(corners[i], corners[i + 1], corners[i + 2]);
    }
    return triangles;
}

/// Number of blend shapes, which all primitives of a mesh share.
int target_count_of(const GltfValue& primitives)
{
    int count = 0;
    for (int p = 0; p < primitives.size(); ++p) {
        const GltfValue targets = primitives[p].list("targets");
        if (p > 0 && targets.size() != count)
            throw InvalidInput(targets.place() + " has " + std::to_string(targets.size()) +
                               " targets; the first primitive has " + std::to_string(count));
        count = targets.size();
    }
    return count;
}

std::string numbered(const char* name, int i) { return name + std::to_string(i); }

} // namespace

std::map<int, ShapeRange> GltfMeshes::read()
{
    const GltfValue nodes = file_.list("nodes"), meshes = file_.list("meshes");
    std::map<int, ShapeRange> shapes_of_node;
    for (size_t done = 0; done < tree_.order.size(); ++done) {
        const LongWork::Part part = LongWork::item(done, tree_.order.size());
        const int node = tree_.order[done];
        const std::optional<GltfValue> mesh = nodes[node].find("mesh");
        if (!mesh || tree_.is_drawn[size_t(node)] == 0)
            continue;
        const GltfValue primitives = meshes[mesh->index(meshes.size(), "meshes")].at("primitives");
        const Binding binding = bind(node, primitives);
        KnownVertices known;
        for (int p = 0; p < primitives.size(); ++p) {
            LongWork::update(double(p) / primitives.size());
            add_primitive(primitives[p], binding, known);
        }
        if (binding.first_shape >= 0)
            shapes_of_node[node] = {binding.first_shape, int(binding.weights.size())};
    }
    return shapes_of_node;
}

GltfMeshes::Binding GltfMeshes::bind(int node, const GltfValue& primitives)
{
    Binding binding;
    if (const std::optional<GltfValue> index = file_.list("nodes")[node].find("skin")) {
        const GltfValue skins = file_.list("skins");
        const int skin = index->index(skins.size(), "skins");
        const auto [known, is_new] = of_skin_.try_emplace(skin);
        if (is_new) {
            known->second.is_skinned = true;
            enter_space(bones_of_skin(skins[skin]), known->second);
        }
        binding = known->second;
    } else {
        enter_space({{tree_.joint_of_node[size_t(node)], identity_affine()}}, binding);
    }

    binding.weights = default_weights(node, target_count_of(primitives));
    if (animated_nodes_.contains(node)) {
        std::vector<double>& all_weights = builder_.mesh().shape_weights;
        binding.first_shape = int(all_weights.size());
        all_weights.insert(all_weights.end(), binding.weights.begin(), binding.weights.end());
    }
    return binding;
}

/// The node's own weights, else its mesh's, else zero.
std::vector<double> GltfMeshes::default_weights(int node, int target_count) const
{
    const GltfValue node_value = file_.list("nodes")[node];
    const GltfValue mesh =
        file_.list("meshes")[node_value.at("mesh").index(file_.list("meshes").size(), "meshes")];
    for (const GltfValue& owner : {node_value, mesh})
        if (const std::optional<GltfValue> weights = owner.find("weights"))
            return weights->numbers(target_count);
    return std::vector<double>(size_t(target_count), 0.0);
}

std::vector<Bone> GltfMeshes::bones_of_skin(const GltfValue& skin)
{
    const GltfValue joints = skin.at("joints");
    std::vector<Bone> bones;
    bones.reserve(size_t(joints.size()));
    for (int i = 0; i < joints.size(); ++i)
        bones.push_back({tree_.joint_of_node[size_t(joints[i].index(int(tree_.order.size()), "nodes"))],
                         identity_affine()});
    const std::optional<GltfValue> reference = skin.find("inverseBindMatrices");
    if (!reference)
        return bones;

    const Elements matrices = accessors_.read(*reference, kMatrices);
    if (matrices.count < joints.size())
        reference->refuse("this accessor has " + std::to_string(matrices.count) + " matrices for " +
                          std::to_string(joints.size()) + " joints");
    for (int i = 0; i < joints.size(); ++i)
        bones[size_t(i)].joint_from_mesh = affine_of(matrices[i], *reference);
    return bones;
}

/// Bones that two skins have in common show that both are in one mesh space.
void GltfMeshes::enter_space(const std::vector<Bone>& bones, Binding& binding)
{
    for (const Bone& bone : bones)
        binding.bones.push_back(builder_.add_bone(bone));
    space_of_bone_.resize(builder_.mesh().bones.size(), -1);
    for (const int bone : binding.bones)
        if (binding.space < 0)
            binding.space = space_of_bone_[size_t(bone)];
    if (binding.space < 0)
        binding.space = space_count_++;
    for (const int bone : binding.bones)
        space_of_bone_[size_t(bone)] = binding.space;
}

void GltfMeshes::add_primitive(const GltfValue& primitive, const Binding& binding, KnownVertices& known)
{
    file_.spend(primitive, 1 + std::uint64_t(primitive.list("targets").size()));
    const PrimitiveMode mode = mode_of(primitive);
    if (mode < kTriangles || !primitive.at("attributes").find("POSITION"))
        return;
    const auto [vertices, is_new] = known.try_emplace(sources_of(primitive));
    if (is_new)
        vertices->second = add_vertices(primitive, binding);
    const std::vector<int> corners = corners_of(primitive, vertices->second);
    if (mode == kTriangles && corners.size() % 3 != 0)
        throw InvalidInput(primitive.place() + " has " + std::to_string(corners.size()) +
                           " corners; triangles take a multiple of 3");
    const std::vector<Triangle> triangles = triangles_of(corners, mode);
    std::vector<Triangle>& all = builder_.mesh().rest.triangles;
    primitives_.push_back({primitive, int(all.size()), vertices->second.first, vertices->second.count});
    all.insert(all.end(), triangles.begin(), triangles.end());
}

/// Accessors that the vertices come from, by attribute or target; -1 for a target without positions.
std::map<std::string, int> GltfMeshes::sources_of(const GltfValue& primitive) const
{
    const int accessor_count = file_.list("accessors").size();
    const GltfValue attributes = primitive.at("attributes"), targets = primitive.list("targets");
    std::map<std::string, int> sources;
    for (const std::string& key : attributes.keys())
        if (key == "POSITION" || key.starts_with("JOINTS_") || key.starts_with("WEIGHTS_"))
            sources[key] = attributes.at(key).index(accessor_count, "accessors");
    for (int t = 0; t < targets.size(); ++t) {
        const std::optional<GltfValue> offset = targets[t].find("POSITION");
        sources[numbered("targets_", t)] = offset ? offset->index(accessor_count, "accessors") : -1;
    }
    return sources;
}

/// Vertices at the corners of the primitive's triangles; without indices all vertices in a row.
std::vector<int> GltfMeshes::corners_of(const GltfValue& primitive, const VertexRange& vertices)
{
    std::vector<int> corners;
    const std::optional<GltfValue> indices = primitive.find("indices");
    if (!indices) {
        file_.spend(primitive, std::uint64_t(vertices.count));
        for (int v = 0; v < vertices.count; ++v)
            corners.push_back(vertices.first + v);
        return corners;
    }
    const Elements elements = accessors_.read(*indices, kIndices);
    corners.reserve(size_t(elements.count));
    for (int i = 0; i < elements.count; ++i) {
        const double vertex = *elements[i];
        if (!(vertex < vertices.count))
            indices->refuse("index " + std::to_string(i) + " of this accessor is " +
                            std::to_string(std::int64_t(vertex)) + "; the primitive has " +
                            std::to_string(vertices.count) + " vertices");
        corners.push_back(vertices.first + int(vertex));
    }
    return corners;
}

GltfMeshes::VertexRange GltfMeshes::add_vertices(const GltfValue& primitive, const Binding& binding)
{
    SkinnedMesh& mesh = builder_.mesh();
    const GltfValue attributes = primitive.at("attributes");
    const Elements positions = accessors_.read(attributes.at("POSITION"), kPosition);
    const VertexRange vertices{mesh.rest.vertex_count(), positions.count};
    for (int v = 0; v < positions.count; ++v)
        mesh.rest.positions.emplace_back(Eigen::Map<const Vec3>(positions[v]));
    mesh.space_of_vertex.resize(mesh.rest.positions.size(), binding.space);
    add_influences(attributes, binding, positions.count);
    add_shapes(primitive.list("targets"), binding, vertices);
    return vertices;
}

void GltfMeshes::add_influences(const GltfValue& attributes, const Binding& binding, int vertex_count)
{
    SkinnedMesh& mesh = builder_.mesh();
    std::vector<std::pair<Elements, Elements>> sets; // joints and weights, four each
    if (binding.is_skinned) {
        attributes.at("JOINTS_0");
        for (int set = 0; attributes.find(numbered("JOINTS_", set)); ++set)
            sets.emplace_back(
                accessors_.read(attributes.at(numbered("JOINTS_", set)), kJoints, vertex_count),
                accessors_.read(attributes.at(numbered("WEIGHTS_", set)), kWeights, vertex_count));
    }
    for (int v = 0; v < vertex_count; ++v) {
        if (!binding.is_skinned)
            mesh.influences.push_back({binding.bones.front(), 1.0});
        for (size_t set = 0; set < sets.size(); ++set)
            for (int k = 0; k < 4; ++k) {
                const double joint = sets[set].first[v][k], weight = sets[set].second[v][k];
                if (weight == 0.0)
                    continue;
                if (!(joint < double(binding.bones.size())))
                    attributes.at(numbered("JOINTS_", int(set)))
                        .refuse("vertex " + std::to_string(v) + " follows joint " +
                                std::to_string(int(joint)) + "; the skin has " +
                                std::to_string(binding.bones.size()));
                mesh.influences.push_back({binding.bones[size_t(joint)], weight});
            }
        mesh.first.push_back(int(mesh.influences.size()));
    }
}

/// Applies blend shapes at their weights, or keeps them where they move.
void GltfMeshes::add_shapes(const GltfValue& targets, const Binding& binding, const VertexRange& vertices)
{
    SkinnedMesh& mesh = builder_.mesh();
    std::vector<std::vector<ShapeOffset>> kept(static_cast<size_t>(vertices.count));
    for (int t = 0; t < targets.size(); ++t) {
        const std::optional<GltfValue> reference = targets[t].find("POSITION");
        if (!reference)
            continue;
        const Elements offsets = accessors_.read(*reference, kPosition, vertices.count);
        for (int v = 0; v < vertices.count; ++v) {
            const Eigen::Map<const Vec3> offset(offsets[v]);
            if (binding.first_shape < 0)
                mesh.rest.positions[size_t(vertices.first) + size_t(v)] +=
                    binding.weights[size_t(t)] * offset;
            else if (!offset.isZero(0.0))
                kept[size_t(v)].push_back({binding.first_shape + t, offset});
        }
    }

    if (mesh.first_offset.empty())
        mesh.first_offset.push_back(0);
    for (const std::vector<ShapeOffset>& offsets : kept) {
        mesh.offsets.insert(mesh.offsets.end(), offsets.begin(), offsets.end());
        mesh.first_offset.push_back(int(mesh.offsets.size()));
    }
}

} // namespace toile::avatars
