#include "export/point_cache.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "core/base/error.h"
#include "export/alembic/abc_cache.h"
#include "export/binary_file.h"
#include "export/byte_order.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/pc2/pc2_writer.h"
#include "export/ply/ply_file.h"
#include "export/sequence/numbered_files.h"
#include "export/times/frame_times.h"
#include "export/usd/usd_cache.h"

namespace toile::exports {

namespace {

using std::filesystem::path;

/// Relative error of a number in single precision.
constexpr double kSingleRounding = 0x1p-24;

[[noreturn]] void refuse(const path& file, const std::string& why)
{
    throw InvalidInput(file.string() + ": " + why);
}

/// Reads the first `size` bytes of a file.
std::string read_head(const BinaryFile& file, std::int64_t size, const char* format)
{
    if (file.size() < size)
        refuse(file.path(), "ends at byte " + std::to_string(file.size()) + ", within the " +
                                std::to_string(size) + "-byte " + format + " header; export the cache again");
    std::string head(size_t(size), '\0');
    file.read_at(0, head.data(), head.size());
    return head;
}

template <std::endian kOrder>
std::vector<Vec3> decode_positions(const std::string& bytes)
{
    std::vector<Vec3> positions(bytes.size() / 12);
    for (size_t v = 0; v < positions.size(); ++v)
        for (int axis = 0; axis < 3; ++axis)
            positions[v][axis] = double(get<kOrder, float>(&bytes[12 * v + 4 * size_t(axis)]));
    return positions;
}

/// Frames of equal size behind a header: the common part of PC2 and MDD.
template <std::endian kOrder>
class BinarySource : public PointCache::Source {
public:
    explicit BinarySource(const path& file) : file_(file, BinaryFile::Mode::Read) {}

    std::vector<Vec3> frame(int index) const final
    {
        std::string bytes(size_t(frame_size()), '\0');
        file_.read_at(first_frame_at_ + frame_size() * index, bytes.data(), bytes.size());
        return decode_positions<kOrder>(bytes);
    }

protected:
    std::int64_t frame_size() const { return 12 * std::int64_t(vertex_count); }

    /// Compares the number of frames in the header with the bytes behind it.
    void require_size(const char* format, bool may_have_more)
    {
        const std::int64_t bytes = file_.size() - first_frame_at_;
        if (bytes / frame_size() < frame_count)
            refuse(file_.path(), "truncated at byte " + std::to_string(file_.size()) + ": the " + format +
                                     " header promises " + std::to_string(frame_count) + " frames of " +
                                     std::to_string(vertex_count) + " points, " +
                                     std::to_string(bytes / frame_size()) +
                                     " are complete; export the cache again");
        if (bytes > frame_size() * frame_count && !may_have_more)
            refuse(file_.path(), std::to_string(bytes - frame_size() * frame_count) +
                                     " bytes follow the last frame at byte " +
                                     std::to_string(first_frame_at_ + frame_size() * frame_count) +
                                     "; this is no " + format + " of " + std::to_string(frame_count) +
                                     " frames, export the cache again");
    }

    BinaryFile file_;
    std::int64_t first_frame_at_ = 0;
};

class Pc2Source final : public BinarySource<std::endian::little> {
public:
    explicit Pc2Source(const path& file) : BinarySource(file)
    {
        constexpr std::endian kLittle = std::endian::little;
        const std::string header = read_head(file_, kPc2HeaderSize, "PC2");
        if (header.compare(0, 12, std::string("POINTCACHE2\0", 12)) != 0)
            refuse(file, "does not start with POINTCACHE2 (byte 0); this is no PC2 file");
        const auto version = get<kLittle, std::int32_t>(&header[12]);
        vertex_count = get<kLittle, std::int32_t>(&header[16]);
        start_frame = double(get<kLittle, float>(&header[20]));
        frame_count = get<kLittle, std::int32_t>(&header[kPc2SampleCountAt]);
        const double samples_per_frame = std::round(1.0 / double(get<kLittle, float>(&header[24])));
        if (samples_per_frame >= 1.0 && samples_per_frame <= kMaxSubframes) // else of another meaning
            subframes = int(samples_per_frame);
        if (version != 1)
            refuse(file, "PC2 version " + std::to_string(version) + " (byte 12); only version 1 is known");
        if (vertex_count < 1 || frame_count < 0)
            refuse(file, "the header says " + std::to_string(vertex_count) + " points (byte 16) and " +
                             std::to_string(frame_count) + " frames (byte 28); export the cache again");

        // A run killed between data and count leaves a frame that is not counted yet.
        first_frame_at_ = kPc2HeaderSize;
        require_size("PC2", file.stem().extension() == ".partial");
    }
};

class MddSource final : public BinarySource<std::endian::big> {
public:
    explicit MddSource(const path& file) : BinarySource(file)
    {
        constexpr std::endian kBig = std::endian::big;
        const std::string header = read_head(file_, 8, "MDD");
        frame_count = get<kBig, std::int32_t>(&header[0]);
        vertex_count = get<kBig, std::int32_t>(&header[4]);
        if (frame_count < 1 || vertex_count < 1)
            refuse(file, "the header says " + std::to_string(frame_count) + " frames (byte 0) and " +
                             std::to_string(vertex_count) + " points (byte 4); this is no MDD file");
        first_frame_at_ = 8 + 4 * std::int64_t(frame_count);
        const std::string head = read_head(file_, first_frame_at_, "MDD");
        require_size("MDD", false);

        if (frame_count < 2)
            return;
        std::vector<double> seconds;
        for (size_t at = 8; at < head.size(); at += 4)
            seconds.push_back(double(get<kBig, float>(&head[at])));
        const double largest = std::max(std::fabs(seconds.front()), std::fabs(seconds.back()));
        if (const auto found = frame_times(seconds, largest * kSingleRounding, std::nullopt)) {
            fps = found->fps;
            start_frame = found->start_frame;
        } else {
            times = std::move(seconds);
        }
    }
};

/// Reads a mesh, or its positions alone.
struct MeshFileReader {
    ObjMesh (*mesh)(const path&);
    std::vector<Vec3> (*positions)(const path&); ///< null: of a format that does not tell when it is cut off
    std::optional<Axes> (*axes)(const path&);
};

constexpr MeshFileReader kObjReader{[](const path& file) { return read_obj(file); }, nullptr,
                                    [](const path&) { return std::optional<Axes>(); }};
constexpr MeshFileReader kPlyReader{read_ply, read_ply_positions, read_ply_axes};

class MeshFileSource final : public PointCache::Source {
public:
    MeshFileSource(std::vector<path> files, const MeshFileReader& reader)
        : files_(std::move(files)), reader_(reader)
    {
        frame_count = int(files_.size());
        axes = reader_.axes(files_.front());
        mesh = reader_.mesh(files_.front());
        vertex_count = int(mesh.positions.size());
        if (mesh.polygons.empty())
            refuse(files_.front(), "has no faces; a cache of such files needs its surface");
    }

    std::vector<Vec3> frame(int index) const override
    {
        const path& file = files_[size_t(index)];
        if (reader_.positions == nullptr)
            return positions_of_whole(file);
        std::vector<Vec3> positions = reader_.positions(file);
        require_same("vertices", file, positions.size(), size_t(vertex_count));
        return positions;
    }

private:
    /// The faces follow the vertices: where they are those of the first file, nothing is missing.
    std::vector<Vec3> positions_of_whole(const path& file) const
    {
        ObjMesh whole = reader_.mesh(file);
        require_same("vertices", file, whole.positions.size(), size_t(vertex_count));
        require_same("faces", file, whole.polygons.size(), mesh.polygons.size());
        const auto [mine, first] =
            std::mismatch(whole.polygons.begin(), whole.polygons.end(), mesh.polygons.begin());
        if (mine != whole.polygons.end())
            refuse(file, "its face " + std::to_string(first - mesh.polygons.begin()) + " is not that of " +
                             files_.front().string() + kSameMesh);
        return std::move(whole.positions);
    }

    void require_same(const char* what, const path& file, size_t count, size_t of_first) const
    {
        if (count != of_first)
            refuse(file, "has " + std::to_string(count) + " " + what + " and " + files_.front().string() +
                             " " + std::to_string(of_first) + kSameMesh);
    }

    static constexpr const char* kSameMesh =
        "; all frames of a sequence need the same mesh, and one of these is of another or cut off";

    std::vector<path> files_;
    MeshFileReader reader_;
};

PointCache read_mesh_files(const path& file, const MeshFileReader& reader)
{
    if (!NumberedFiles::has_digits_placeholder(file) && std::filesystem::exists(file))
        return PointCache(std::make_unique<MeshFileSource>(std::vector<path>{file}, reader));

    const NumberedFiles sequence(file);
    const std::vector<int> numbers = sequence.existing();
    if (numbers.empty())
        refuse(file, "can't be found, nor a sequence beginning with " + sequence.file(0).filename().string() +
                         "; check the path");
    std::vector<path> files;
    for (size_t k = 0; k < numbers.size(); ++k) {
        if (numbers[k] != numbers[0] + int(k))
            refuse(sequence.file(numbers[0] + int(k)), "missing, but later frames exist; restore the frame "
                                                       "or remove the later ones");
        files.push_back(sequence.file(numbers[k]));
    }
    auto source = std::make_unique<MeshFileSource>(std::move(files), reader);
    source->start_frame = numbers[0];
    return PointCache(std::move(source));
}

} // namespace

std::vector<Vec3> PointCache::frame(int index) const
{
    if (index < 0 || index >= frame_count())
        throw InvalidInput("frame " + std::to_string(index) + " was asked of a cache of " +
                           std::to_string(frame_count()) + " frames; they count from 0");
    return source_->frame(index);
}

std::vector<Vec3> PointCache::frame_in_metres(int index) const
{
    std::vector<Vec3> positions = frame(index);
    change_axes(axes().value_or(Axes{}), Axes{}, positions);
    return positions;
}

PointCache read_cache(const path& file)
{
    switch (format_to_read(file)) {
    case CacheFormat::Pc2:
        return PointCache(std::make_unique<Pc2Source>(file));
    case CacheFormat::Mdd:
        return PointCache(std::make_unique<MddSource>(file));
    case CacheFormat::Abc:
        return PointCache(open_abc(file));
    case CacheFormat::Usd:
        return PointCache(open_usd(file));
    case CacheFormat::Obj:
        return read_mesh_files(file, kObjReader);
    case CacheFormat::Ply:
        return read_mesh_files(file, kPlyReader);
    case CacheFormat::Glb:
    case CacheFormat::Vtk:
        break;
    }
    return PointCache(nullptr); // format_to_read() refuses these
}

std::vector<path> meshes_of_cache(const path& file)
{
    const CacheFormat format = format_to_read(file);
    if ((format != CacheFormat::Abc && format != CacheFormat::Usd) || !mesh_path_of(file).empty())
        return {file};
    std::vector<path> meshes;
    for (const std::string& mesh : format == CacheFormat::Abc ? abc_mesh_paths(file) : usd_mesh_paths(file))
        meshes.push_back(file.string() + "#" + mesh);
    return meshes;
}

} // namespace toile::exports
