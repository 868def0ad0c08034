#pragma once

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "core/mesh/triangle_mesh.h"

namespace toile::test {

/// Rigid part of a jointed body, bound to a single joint, and its motion.
struct BodyPart {
    struct Key {
        double time;                   ///< [s]
        Vec3 translate = Vec3::Zero(); ///< [m] added to the pivot
        Vec3 axis = Vec3::UnitZ();
        double angle = 0.0; ///< [rad] about the axis through the pivot
    };

    std::string joint;
    TriangleMesh mesh; ///< [m]
    std::vector<Key> keys{{0.0}};
    Vec3 pivot = Vec3::Zero(); ///< position of the joint [m]
    int parent = -1;           ///< index of an earlier part
};

/// Bytes of a glTF buffer, with the views and accessors into it.
class GltfBuffer {
public:
    nlohmann::json views = nlohmann::json::array();
    nlohmann::json accessors = nlohmann::json::array();

    /// Appends `count` items of `type` with equally many components, and returns the accessor.
    template <typename T>
    int add(const std::vector<T>& components, int count, const char* type)
    {
        constexpr int kFloat = 5126, kUnsignedShort = 5123;
        const size_t first = bytes_.size(), size = components.size() * sizeof(T);
        bytes_.resize(first + (size + 3) / 4 * 4);
        std::memcpy(bytes_.data() + first, components.data(), size);
        views.push_back({{"buffer", 0}, {"byteOffset", first}, {"byteLength", size}});
        accessors.push_back({{"bufferView", views.size() - 1},
                             {"componentType", sizeof(T) == 4 ? kFloat : kUnsignedShort},
                             {"count", count},
                             {"type", type}});
        return int(accessors.size()) - 1;
    }

    nlohmann::json buffer() const
    {
        static const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text = "data:application/octet-stream;base64,";
        for (size_t i = 0; i < bytes_.size(); i += 3) {
            uint32_t three = 0;
            for (size_t k = 0; k < 3; ++k)
                three = (three << 8) | (i + k < bytes_.size() ? bytes_[i + k] : 0u);
            for (size_t k = 0; k < 4; ++k)
                text += i + k <= bytes_.size() ? kDigits[(three >> (18 - 6 * k)) & 63] : '=';
        }
        return {{"byteLength", bytes_.size()}, {"uri", text}};
    }

private:
    std::vector<unsigned char> bytes_;
};

/// Writes the parts as one animated mesh with a clip "move".
inline void write_gltf(const std::filesystem::path& file, const std::vector<BodyPart>& parts)
{
    using Json = nlohmann::json;
    std::vector<float> positions, weights, inverse_bind;
    std::vector<uint16_t> indices, joints;
    for (size_t p = 0; p < parts.size(); ++p) {
        const auto first = uint16_t(positions.size() / 3);
        for (const Vec3& x : parts[p].mesh.positions) {
            for (int k = 0; k < 3; ++k)
                positions.push_back(float(x[k]));
            joints.insert(joints.end(), {uint16_t(p), 0, 0, 0});
            weights.insert(weights.end(), {1.0f, 0.0f, 0.0f, 0.0f});
        }
        for (const Triangle& t : parts[p].mesh.triangles)
            for (const int v : t)
                indices.push_back(uint16_t(first + v));
        const Vec3 pivot = parts[p].pivot;
        inverse_bind.insert(inverse_bind.end(), {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, float(-pivot.x()),
                                                 float(-pivot.y()), float(-pivot.z()), 1});
    }
    GltfBuffer data;
    const int vertices = int(positions.size() / 3);
    const Json attributes = {{"POSITION", data.add(positions, vertices, "VEC3")},
                             {"JOINTS_0", data.add(joints, vertices, "VEC4")},
                             {"WEIGHTS_0", data.add(weights, vertices, "VEC4")}};
    Json gltf = {{"asset", {{"version", "2.0"}}}, {"scene", 0}};
    gltf["meshes"] = {
        {{"primitives",
          {{{"attributes", attributes}, {"indices", data.add(indices, int(indices.size()), "SCALAR")}}}}}};

    // Node 0 has the mesh, node 1 + p the joint of part p.
    Json nodes = {{{"name", "body"}, {"mesh", 0}, {"skin", 0}}};
    Json roots = {0}, joint_nodes = Json::array(), channels = Json::array(), samplers = Json::array();
    for (size_t p = 0; p < parts.size(); ++p) {
        const BodyPart& part = parts[p];
        const Vec3 at = part.parent < 0 ? part.pivot : Vec3(part.pivot - parts[size_t(part.parent)].pivot);
        nodes.push_back({{"name", part.joint}, {"translation", {at.x(), at.y(), at.z()}}});
        joint_nodes.push_back(p + 1);
        if (part.parent < 0)
            roots.push_back(p + 1);
        else
            nodes[size_t(part.parent) + 1]["children"].push_back(p + 1);
        std::vector<float> times, translations, rotations;
        for (const BodyPart::Key& key : part.keys) {
            times.push_back(float(key.time));
            const Eigen::Quaterniond rotation(Eigen::AngleAxisd(key.angle, key.axis));
            for (int k = 0; k < 3; ++k)
                translations.push_back(float(at[k] + key.translate[k]));
            for (int k = 0; k < 4; ++k)
                rotations.push_back(float(rotation.coeffs()[k]));
        }
        const int count = int(times.size()), input = data.add(times, count, "SCALAR");
        for (const auto& [path, output] : {std::pair("translation", data.add(translations, count, "VEC3")),
                                           std::pair("rotation", data.add(rotations, count, "VEC4"))}) {
            channels.push_back({{"sampler", samplers.size()}, {"target", {{"node", p + 1}, {"path", path}}}});
            samplers.push_back({{"input", input}, {"output", output}});
        }
    }
    gltf["skins"] = {{{"joints", joint_nodes},
                      {"inverseBindMatrices", data.add(inverse_bind, int(parts.size()), "MAT4")}}};
    gltf["scenes"] = {{{"nodes", roots}}};
    gltf["nodes"] = nodes;
    gltf["animations"] = {{{"name", "move"}, {"channels", channels}, {"samplers", samplers}}};
    gltf["accessors"] = data.accessors;
    gltf["bufferViews"] = data.views;
    gltf["buffers"] = {data.buffer()};
    std::ofstream(file) << gltf.dump();
}

} // namespace toile::test
