#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "avatars/import/gltf_json.h"

namespace toile::avatars {

using Bytes = std::span<const unsigned char>;

/// Offset of an accessor or view [bytes], 0 without one.
std::uint64_t offset_of(const GltfValue& object);

/// A glTF file: its JSON, and its buffers from wherever they are.        [glTF 2.0, sections 3.6.1, 4]
class GltfFile {
public:
    /// Reads a .gltf or .glb file, told apart by content.
    /// @throws InvalidInput for a file that can't be read, that is no JSON, of another version than 2, or
    /// that
    ///         requires an extension which changes geometry and is not read.
    explicit GltfFile(const std::filesystem::path& file);
    GltfFile(const GltfFile&) = delete;
    GltfFile& operator=(const GltfFile&) = delete;

    const GltfValue& root() const { return root_; }

    /// A top-level array, such as "nodes"; empty if the file has none.
    GltfValue list(const std::string& key) const { return root_.list(key); }

    /// Bytes of buffer i, `byteLength` of them. Read on first use: embedded, from another file, or the binary
    /// chunk of a .glb.
    /// @param i  below the number of buffers
    /// @throws InvalidInput for a missing or short file, and bad base64.
    Bytes buffer(int i);

    /// Bytes of a buffer view.
    /// @throws InvalidInput for a view outside of its buffer, and as buffer()
    Bytes view(const GltfValue& view);

    /// Whole content of what a URI names: embedded, or another file.
    /// @throws InvalidInput for a missing file, and bad base64
    std::vector<unsigned char> content_of(const GltfValue& uri) const;

    /// Counts elements that are about to be read for `place`. A few kilobytes can name one accessor from a
    /// million places, so that memory would not be bounded by the size of the file.
    /// @throws InvalidInput beyond one element per byte and kMaxRepeats.
    void spend(const GltfValue& place, std::uint64_t elements);

private:
    void parse(std::string_view json);
    std::string_view split_glb();
    void require_version() const;
    void require_known_extensions() const;
    std::filesystem::path file_beside(const GltfValue& uri) const;

    std::filesystem::path file_;
    std::string source_;
    std::string content_;
    Bytes binary_chunk_;
    GltfValue::Json json_;
    GltfValue root_;
    std::map<int, std::vector<unsigned char>> loaded_; ///< buffers from elsewhere than binary_chunk_
    std::uint64_t byte_count_ = 0;                     ///< of the file and what is loaded
    std::uint64_t spent_ = 0;                          ///< elements
};

/// Elements that may be read from a file, beside one per byte.
inline constexpr std::uint64_t kMaxRepeats = 4'000'000;

} // namespace toile::avatars
