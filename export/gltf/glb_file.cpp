#include "export/gltf/glb_file.h"

#include <array>
#include <cstdint>
#include <sstream>
#include <utility>

// Compiled here: its shared library would be one more that programs need, for its readers of images.
#define TINYGLTF_IMPLEMENTATION
#define TINYGLTF_NO_STB_IMAGE
#define TINYGLTF_NO_STB_IMAGE_WRITE
#define TINYGLTF_NO_EXTERNAL_IMAGE
#include <tiny_gltf.h>

#include "core/base/error.h"
#include "export/byte_order.h"
#include "export/gltf/glb_mesh.h"

namespace toile::exports {

namespace {

using Coordinates = Eigen::Ref<const Eigen::VectorXf>; // [3 vertices]

/// Largest buffer [bytes]: sizes in the file have 32 bits. The rest is for its text.
constexpr std::size_t kMaxBuffer = 0xf0000000;

class GlbBuilder {
public:
    GlbBuilder(const CacheLayout& layout, const ShapeAnimation& animation)
        : animation_(animation), first_frame_(animation.frame(0))
    {
        model_.asset.version = "2.0";
        model_.asset.generator = "toile";
        model_.buffers.resize(1);
        model_.scenes.resize(1);
        model_.defaultScene = 0;

        // Cloth has two sides, and shines little.
        tinygltf::Material& material = model_.materials.emplace_back();
        material.name = "cloth";
        material.doubleSided = true;
        material.pbrMetallicRoughness.metallicFactor = 0.0;
        material.pbrMetallicRoughness.roughnessFactor = 0.9;

        int first = 0; // vertex of the mesh
        for (const CacheMesh& mesh : layout.meshes) {
            add_mesh(mesh, first);
            first += mesh.vertex_count;
        }
        if (shape_count() > 0)
            add_animation(layout);
    }

    tinygltf::Model& model() { return model_; }

private:
    int shape_count() const { return int(animation_.shapes.cols()); }

    /// @param target  use of the bytes by graphics hardware, or 0
    int add_accessor(const std::string& bytes, int component_type, int type, std::size_t count, int target)
    {
        std::vector<unsigned char>& buffer = model_.buffers[0].data;
        tinygltf::BufferView& view = model_.bufferViews.emplace_back();
        view.buffer = 0;
        view.byteOffset = buffer.size();
        view.byteLength = bytes.size();
        view.target = target;
        buffer.insert(buffer.end(), bytes.begin(), bytes.end());

        tinygltf::Accessor& accessor = model_.accessors.emplace_back();
        accessor.bufferView = int(model_.bufferViews.size()) - 1;
        accessor.componentType = component_type;
        accessor.type = type;
        accessor.count = count;
        return int(model_.accessors.size()) - 1;
    }

    int add_floats(const std::vector<float>& values, int type, int components, int target)
    {
        std::string bytes;
        bytes.reserve(4 * values.size());
        for (const float value : values)
            append(bytes, value);
        return add_accessor(bytes, TINYGLTF_COMPONENT_TYPE_FLOAT, type, values.size() / size_t(components),
                            target);
    }

    /// Positions or displacements of vertices, with the bounds that the format asks for.
    int add_vectors(const Coordinates& of_mesh, const std::vector<int>& vertices)
    {
        std::vector<float> values;
        values.reserve(3 * vertices.size());
        for (const int v : vertices)
            for (int axis = 0; axis < 3; ++axis)
                values.push_back(of_mesh[3 * v + axis]);
        const int accessor = add_floats(values, TINYGLTF_TYPE_VEC3, 3, TINYGLTF_TARGET_ARRAY_BUFFER);
        const Eigen::Map<const Eigen::Matrix3Xf> columns(values.data(), 3, Eigen::Index(vertices.size()));
        for (int axis = 0; axis < 3; ++axis) {
            model_.accessors.back().minValues.push_back(double(columns.row(axis).minCoeff()));
            model_.accessors.back().maxValues.push_back(double(columns.row(axis).maxCoeff()));
        }
        return accessor;
    }

    /// @param first  vertex of the mesh in the cache
    void add_mesh(const CacheMesh& mesh, int first)
    {
        const auto of_mesh = [&](const auto& all) -> Coordinates {
            return all.segment(3 * Eigen::Index(first), 3 * Eigen::Index(mesh.vertex_count));
        };
        const Coordinates shown = of_mesh(first_frame_);
        std::vector<Vec3> positions;
        positions.reserve(size_t(mesh.vertex_count));
        for (int v = 0; v < mesh.vertex_count; ++v)
            positions.push_back(shown.segment<3>(3 * Eigen::Index(v)).cast<double>());
        const GlbMesh drawn = glb_mesh(mesh.faces, positions);

        tinygltf::Primitive primitive;
        primitive.mode = TINYGLTF_MODE_TRIANGLES;
        primitive.material = 0;
        primitive.attributes["POSITION"] = add_vectors(of_mesh(animation_.base), drawn.vertices);
        primitive.attributes["NORMAL"] = add_pairs_or_triples(drawn.normals, TINYGLTF_TYPE_VEC3);
        if (!drawn.texture.empty())
            primitive.attributes["TEXCOORD_0"] = add_pairs_or_triples(drawn.texture, TINYGLTF_TYPE_VEC2);
        primitive.attributes["_VERTEX"] = add_floats({drawn.vertices.begin(), drawn.vertices.end()},
                                                     TINYGLTF_TYPE_SCALAR, 1, TINYGLTF_TARGET_ARRAY_BUFFER);
        std::string indices;
        for (const std::uint32_t index : drawn.triangles)
            append(indices, index);
        primitive.indices = add_accessor(indices, TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT, TINYGLTF_TYPE_SCALAR,
                                         drawn.triangles.size(), TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER);

        tinygltf::Mesh& added = model_.meshes.emplace_back();
        tinygltf::Value::Array names;
        for (int k = 0; k < shape_count(); ++k) {
            primitive.targets.push_back(
                {{"POSITION", add_vectors(of_mesh(animation_.shapes.col(k)), drawn.vertices)}});
            names.push_back(tinygltf::Value("shape " + std::to_string(k + 1)));
            added.weights.push_back(double(animation_.weights(0, k)));
        }
        if (shape_count() > 0) {
            added.extras = tinygltf::Value(tinygltf::Value::Object{{"targetNames", tinygltf::Value(names)}});
        }
        added.name = valid_utf8(mesh.name);
        added.primitives.push_back(std::move(primitive));

        tinygltf::Node& node = model_.nodes.emplace_back();
        node.name = added.name;
        node.mesh = int(model_.meshes.size()) - 1;
        model_.scenes[0].nodes.push_back(int(model_.nodes.size()) - 1);
    }

    template <typename Vector>
    int add_pairs_or_triples(const std::vector<Vector>& vectors, int type)
    {
        std::vector<float> values;
        for (const Vector& vector : vectors)
            for (const double coordinate : vector)
                values.push_back(float(coordinate));
        return add_floats(values, type, int(Vector::RowsAtCompileTime), TINYGLTF_TARGET_ARRAY_BUFFER);
    }

    /// One sampler of weights, which moves every mesh.
    void add_animation(const CacheLayout& layout)
    {
        std::vector<float> times, weights;
        for (int frame = 0; frame < layout.frame_count; ++frame) {
            times.push_back(float(frame / layout.samples_per_second()));
            for (int k = 0; k < shape_count(); ++k)
                weights.push_back(animation_.weights(frame, k));
        }
        tinygltf::AnimationSampler sampler;
        sampler.interpolation = "LINEAR";
        sampler.input = add_floats(times, TINYGLTF_TYPE_SCALAR, 1, 0);
        model_.accessors.back().minValues = {double(times.front())};
        model_.accessors.back().maxValues = {double(times.back())};
        sampler.output = add_floats(weights, TINYGLTF_TYPE_SCALAR, 1, 0);

        tinygltf::Animation& animation = model_.animations.emplace_back();
        animation.name = "simulation";
        animation.samplers.push_back(sampler);
        for (size_t node = 0; node < model_.nodes.size(); ++node) {
            tinygltf::AnimationChannel& channel = animation.channels.emplace_back();
            channel.sampler = 0;
            channel.target_node = int(node);
            channel.target_path = "weights";
        }
    }

    /// Names of files may have any bytes.
    static std::string valid_utf8(const std::string& name)
    {
        using nlohmann::json;
        return json::parse(json(name).dump(-1, ' ', false, json::error_handler_t::replace));
    }

    const ShapeAnimation& animation_;
    Eigen::VectorXf first_frame_;
    tinygltf::Model model_;
};

} // namespace

std::string glb_bytes(const std::string& file, const CacheLayout& layout, const ShapeAnimation& animation,
                      double max_error)
{
    GlbBuilder builder(layout, animation);
    tinygltf::Model& model = builder.model();
    const std::size_t size = model.buffers[0].data.size();
    if (size > kMaxBuffer)
        throw InvalidInput(file + ": would have " + std::to_string(size >> 20) +
                           " MiB, and the format allows 4096; write .abc");
    model.asset.extras =
        tinygltf::Value(tinygltf::Value::Object{{"max_error_m", tinygltf::Value(max_error)},
                                                {"shapes", tinygltf::Value(int(animation.shapes.cols()))}});
    std::ostringstream stream;
    tinygltf::TinyGLTF().WriteGltfSceneToStream(&model, stream, false, true);
    return std::move(stream).str();
}

} // namespace toile::exports
