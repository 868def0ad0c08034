#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace toile::avatars {

/// A value in the JSON of a glTF file, and its place there. Readers throw InvalidInput where the value is not
/// what glTF has at that place: "body.gltf: nodes[3].mesh = 7: index 7 is out of bounds of 2 meshes".
/// Borrows the file's name and JSON.
class GltfValue {
public:
    using Json = nlohmann::json;

    GltfValue(const std::string& source, const Json& json, std::string place)
        : source_(&source), json_(&json), place_(std::move(place))
    {
    }

    /// "body.gltf: nodes[3].mesh"
    std::string place() const { return *source_ + ": " + place_; }
    /// "body.gltf: nodes[3].mesh = 7", long texts cut.
    std::string place_and_value() const;
    /// @param why  what is wrong, and what would be right
    [[noreturn]] void refuse(const std::string& why) const;

    /// Value of a key of this object.
    GltfValue at(const std::string& key) const;
    std::optional<GltfValue> find(const std::string& key) const;
    /// Array below a key of this object; empty if the key is absent.
    GltfValue list(const std::string& key) const;
    /// Keys of this object.
    std::vector<std::string> keys() const;

    /// Length of this array.
    int size() const;
    /// @param i  below size()
    GltfValue operator[](int i) const;

    std::uint64_t whole(std::uint64_t lower, std::uint64_t upper) const;
    /// Index in a top-level array of the file, below `count`.
    int index(int count, const std::string& of_what) const;
    bool flag() const;
    double number() const;
    const std::string& text() const;
    /// "name" of this object on one line; `otherwise` if it has none.
    std::string name_or(const std::string& otherwise) const;
    std::vector<double> numbers() const;
    /// Array of exactly `count` numbers.
    std::vector<double> numbers(int count) const;

private:
    const Json& array() const;
    std::string place_below(const std::string& key) const
    {
        return place_.empty() ? key : place_ + "." + key;
    }

    const std::string* source_;
    const Json* json_;
    std::string place_;
};

} // namespace toile::avatars
