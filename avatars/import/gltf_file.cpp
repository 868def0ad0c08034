#include "avatars/import/gltf_file.h"

#include <algorithm>
#include <array>
#include <fstream>

#include "avatars/import/gltf_uri.h"
#include "core/base/error.h"

namespace toile::avatars {

namespace {

constexpr std::string_view kMagic = "glTF";
constexpr std::uint32_t kJsonChunk = 0x4E4F534A, kBinaryChunk = 0x004E4942;
constexpr std::uint64_t kMaxInteger = std::uint64_t(1) << 53; ///< that doubles hold exactly
constexpr size_t kHeaderSize = 12, kChunkHeaderSize = 8;

/// Extensions that change no position, by the start of their name.
constexpr std::array<std::string_view, 8> kHarmless{"KHR_materials_", "KHR_texture_",         "EXT_texture_",
                                                    "MSFT_texture_",  "KHR_lights_",          "EXT_lights_",
                                                    "KHR_xmp",        "KHR_mesh_quantization"};

/// Little-endian number at a byte of the content, which must have 4 bytes there.
std::uint32_t number_at(std::string_view content, size_t at)
{
    std::uint32_t number = 0;
    for (size_t i = 4; i-- > 0;)
        number = (number << 8) | static_cast<unsigned char>(content[at + i]);
    return number;
}

/// `size` bytes of a regular file from its start.
/// @throws InvalidInput beginning with `place`
template <typename Content>
Content read_start(const std::filesystem::path& file, size_t size, const std::string& place)
{
    Content content(size, 0);
    std::ifstream stream(file, std::ios::binary);
    if (!stream.read(reinterpret_cast<char*>(content.data()), std::streamsize(size)))
        throw InvalidInput(place + ": can't be read; check its permissions");
    return content;
}

/// Size of a regular file.
/// @throws InvalidInput beginning with `place`
size_t size_of(const std::filesystem::path& file, const std::string& place)
{
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error))
        throw InvalidInput(place + ": no such file");
    const std::uintmax_t size = std::filesystem::file_size(file, error);
    if (error)
        throw InvalidInput(place + ": can't be read (" + error.message() + ")");
    return size_t(size);
}

/// What nlohmann's message says, without its number, and cut: it repeats what it has read last.
std::string fact_of(const GltfValue::Json::exception& error)
{
    constexpr size_t kLongest = 200;
    const std::string what = error.what();
    const size_t after_id = what.find("] ");
    const std::string fact = after_id == std::string::npos ? what : what.substr(after_id + 2);
    return fact.size() > kLongest ? fact.substr(0, kLongest) + "..." : fact;
}

/// Advice for a required extension that is not read.
std::string remedy_for(const std::string& extension)
{
    if (extension == "KHR_draco_mesh_compression" || extension == "EXT_meshopt_compression")
        return "save the file without compression";
    return "save the file without this extension";
}

} // namespace

std::uint64_t offset_of(const GltfValue& object)
{
    const std::optional<GltfValue> value = object.find("byteOffset");
    return value ? value->whole(0, kMaxInteger) : 0;
}

GltfFile::GltfFile(const std::filesystem::path& file)
    : file_(file), source_(file.string()),
      content_(read_start<std::string>(file, size_of(file, source_), source_)), root_(source_, json_, "")
{
    byte_count_ = content_.size();
    parse(content_.starts_with(kMagic) ? split_glb() : std::string_view(content_));
    if (!json_.is_object())
        throw InvalidInput(source_ + ": can't be read as glTF: its JSON is no object");
    require_version();
    require_known_extensions();
}

void GltfFile::parse(std::string_view json)
{
    try {
        json_ = GltfValue::Json::parse(json.begin(), json.end());
    } catch (const GltfValue::Json::exception& error) {
        throw InvalidInput(source_ + ": can't be read as glTF: " + fact_of(error));
    }
}

/// The JSON chunk; keeps the place of the binary one.        [glTF 2.0, section 4.4]
std::string_view GltfFile::split_glb()
{
    const auto refuse = [&](const std::string& why) {
        throw InvalidInput(source_ + ": can't be read as binary glTF: " + why);
    };
    if (content_.size() < kHeaderSize)
        refuse("the header is cut off after " + std::to_string(content_.size()) + " bytes");
    if (const std::uint32_t version = number_at(content_, 4); version != 2)
        refuse("container version " + std::to_string(version) + "; 2 is read");
    const size_t length = number_at(content_, 8);
    if (length > content_.size())
        refuse("the header says " + std::to_string(length) + " bytes, the file has " +
               std::to_string(content_.size()));

    // The first chunk is JSON, the second, if any, binary. Further chunks belong to extensions.
    std::string_view json;
    for (size_t at = kHeaderSize, chunk = 0; at + kChunkHeaderSize <= length && chunk < 2; ++chunk) {
        const size_t size = number_at(content_, at);
        const std::uint32_t type = number_at(content_, at + 4);
        at += kChunkHeaderSize;
        if (size > length - at)
            refuse("chunk " + std::to_string(chunk) + " of " + std::to_string(size) +
                   " bytes is cut off after " + std::to_string(length - at));
        if (chunk == 0 && type != kJsonChunk)
            refuse("the first chunk is no JSON");
        if (chunk == 0)
            json = std::string_view(content_).substr(at, size);
        else if (type == kBinaryChunk)
            binary_chunk_ = {reinterpret_cast<const unsigned char*>(content_.data()) + at, size};
        at += size;
    }
    if (json.empty())
        refuse("it has no JSON");
    return json;
}

void GltfFile::require_version() const
{
    const GltfValue asset = root_.at("asset");
    const GltfValue version = asset.at("version");
    if (!version.text().starts_with("2."))
        version.refuse("version 2 of glTF is read; save the file as glTF 2.0");
    const std::optional<GltfValue> needed = asset.find("minVersion");
    if (needed && needed->text() != "2.0")
        needed->refuse("version 2.0 of glTF is read");
}

void GltfFile::require_known_extensions() const
{
    const GltfValue required = root_.list("extensionsRequired");
    for (int i = 0; i < required.size(); ++i) {
        const std::string& name = required[i].text();
        if (std::none_of(kHarmless.begin(), kHarmless.end(),
                         [&](std::string_view start) { return name.starts_with(start); }))
            required[i].refuse("this extension is not read; " + remedy_for(name));
    }
}

Bytes GltfFile::buffer(int i)
{
    const GltfValue buffer = list("buffers")[i];
    const GltfValue length = buffer.at("byteLength");
    const size_t size = length.whole(1, kMaxInteger);
    const auto require = [&](size_t available) {
        if (available < size)
            length.refuse("the buffer has " + std::to_string(available) + " bytes; the file is cut off");
    };

    // The binary chunk of a .glb is its first buffer.
    const std::optional<GltfValue> uri = buffer.find("uri");
    if (!uri) {
        if (i > 0 || binary_chunk_.empty())
            throw InvalidInput(buffer.place() + " has no data: neither a uri nor a binary chunk");
        require(binary_chunk_.size());
        return binary_chunk_.first(size);
    }

    if (const auto known = loaded_.find(i); known != loaded_.end())
        return known->second;
    std::vector<unsigned char>& bytes = loaded_[i];
    if (is_data_uri(uri->text())) {
        bytes = decode_data_uri(*uri);
        require(bytes.size());
        bytes.resize(size);
    } else {
        const std::filesystem::path other = file_beside(*uri);
        const std::string place = uri->place_and_value();
        require(size_of(other, place));
        bytes = read_start<std::vector<unsigned char>>(other, size, place);
    }
    byte_count_ += bytes.size();
    return bytes;
}

std::filesystem::path GltfFile::file_beside(const GltfValue& uri) const
{
    std::filesystem::path file = file_.parent_path() / decode_path(uri);
    if (std::error_code error; !std::filesystem::is_regular_file(file, error))
        uri.refuse("no such file beside this one");
    return file;
}

std::vector<unsigned char> GltfFile::content_of(const GltfValue& uri) const
{
    if (is_data_uri(uri.text()))
        return decode_data_uri(uri);
    const std::filesystem::path file = file_beside(uri);
    const std::string place = uri.place_and_value();
    return read_start<std::vector<unsigned char>>(file, size_of(file, place), place);
}

Bytes GltfFile::view(const GltfValue& view)
{
    const Bytes bytes = buffer(view.at("buffer").index(list("buffers").size(), "buffers"));
    const std::uint64_t start = offset_of(view);
    const GltfValue byte_length = view.at("byteLength");
    const std::uint64_t length = byte_length.whole(1, kMaxInteger);
    if (start > bytes.size() || length > bytes.size() - start)
        byte_length.refuse("with offset " + std::to_string(start) + " the view ends after its buffer of " +
                           std::to_string(bytes.size()) + " bytes");
    return bytes.subspan(size_t(start), size_t(length));
}

void GltfFile::spend(const GltfValue& place, std::uint64_t elements)
{
    spent_ += elements;
    if (spent_ > byte_count_ + kMaxRepeats)
        place.refuse("from here on the file repeats its " + std::to_string(byte_count_) +
                     " bytes into more than " + std::to_string(kMaxRepeats) +
                     " elements; an avatar is one body");
}

} // namespace toile::avatars
