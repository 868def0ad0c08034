#pragma once

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/avatars/column.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

/// A glTF file under construction, from the JSON of another.
struct GltfSample {
    nlohmann::json json;

    /// The file of tests/avatars/column.h.
    static GltfSample column() { return {nlohmann::json::parse(std::ifstream(column_file()))}; }

    /// One triangle in the plane z = 0, with its normal along +Z: node 0, accessor 0.
    static GltfSample triangle()
    {
        GltfSample sample{nlohmann::json::parse(R"({
            "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
            "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
            "accessors": [], "bufferViews": [], "buffers": []})")};
        sample.add<float>({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        return sample;
    }

    nlohmann::json& at(const std::string& pointer) { return json[nlohmann::json::json_pointer(pointer)]; }

    /// Adds an accessor with a buffer of its own.
    /// @return its index
    template <typename Component>
    int add(const std::vector<Component>& numbers, const std::string& type, bool normalized = false)
    {
        std::vector<unsigned char> bytes(numbers.size() * sizeof(Component));
        std::memcpy(bytes.data(), numbers.data(), bytes.size());
        json["buffers"].push_back(
            {{"byteLength", bytes.size()}, {"uri", "data:application/octet-stream;base64," + base64(bytes)}});
        json["bufferViews"].push_back({{"buffer", json["buffers"].size() - 1}, {"byteLength", bytes.size()}});
        const size_t width = type == "SCALAR" ? 1
                             : type == "VEC2" ? 2
                             : type == "VEC3" ? 3
                             : type == "VEC4" ? 4
                                              : 16;
        json["accessors"].push_back({{"bufferView", json["bufferViews"].size() - 1},
                                     {"componentType", component_type(Component())},
                                     {"count", numbers.size() / width},
                                     {"type", type},
                                     {"normalized", normalized}});
        return int(json["accessors"].size()) - 1;
    }

    /// Adds a clip that moves one path of one node.
    void animate(const std::string& name, int node, const std::string& path, int input, int output,
                 const std::string& interpolation = "LINEAR")
    {
        json["animations"].push_back(
            {{"name", name},
             {"samplers", {{{"input", input}, {"output", output}, {"interpolation", interpolation}}}},
             {"channels", {{{"sampler", 0}, {"target", {{"node", node}, {"path", path}}}}}}});
    }

    /// Writes the file under a name of its test.
    std::filesystem::path saved() const { return save_text(json.dump()); }

    static std::filesystem::path save_text(const std::string& text)
    {
        std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
        std::replace(name.begin(), name.end(), '/', '_');
        std::filesystem::path file = process_folder() / (name + ".gltf");
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }

    static std::string base64(const std::vector<unsigned char>& bytes)
    {
        constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        for (size_t i = 0; i < bytes.size(); i += 3) {
            unsigned bits = 0;
            for (size_t k = 0; k < 3; ++k)
                bits = (bits << 8) | (i + k < bytes.size() ? bytes[i + k] : 0u);
            for (size_t k = 0; k < 4; ++k)
                text += i + k <= bytes.size() ? kDigits[(bits >> (18 - 6 * k)) & 63u] : '=';
        }
        return text;
    }

private:
    static int component_type(std::int8_t) { return 5120; }
    static int component_type(std::uint8_t) { return 5121; }
    static int component_type(std::int16_t) { return 5122; }
    static int component_type(std::uint16_t) { return 5123; }
    static int component_type(float) { return 5126; }
};

} // namespace toile::test
