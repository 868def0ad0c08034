#include "export/usd/usd_frames.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/LU>

#include "core/base/error.h"
#include "export/archive/polygons.h"
#include "export/byte_order.h"
#include "export/times/frame_times.h"

namespace toile::exports {

namespace {

constexpr std::int64_t kTransform = 16 * sizeof(double), kPoint = 3 * sizeof(float);

/// Scopes of texture coordinates.
enum Scope : std::uint32_t { kNone, kCorners, kPoints };

/// Rows of numbers (x y z 1) times a matrix.
using Transform = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

class UsdFrames final : public PointCache::Source {
public:
    UsdFrames(std::unique_ptr<const BinaryFile> file, std::string name)
        : file_(std::move(file)), name_(std::move(name)), size_(file_->size())
    {
        read_head();
        read_times();
        read_faces();
        read_texture();
        read_groups();
        first_frame_at_ = at_;
        if (size_ - at_ != frame_size() * frame_count)
            refuse("has " + std::to_string(size_ - at_) + " bytes of frames; " + std::to_string(frame_count) +
                   " of " + std::to_string(vertex_count) + " points need " +
                   std::to_string(frame_size() * frame_count));
        finish_faces();
    }

    std::vector<Vec3> frame(int index) const override
    {
        std::string bytes(size_t(frame_size()), '\0');
        file_->read_at(first_frame_at_ + frame_size() * index, bytes.data(), bytes.size());
        const Transform world = transform(bytes);
        const bool moves = !world.isIdentity(0.0);
        std::vector<Vec3> positions;
        positions.reserve(size_t(vertex_count));
        for (size_t at = kTransform; at < bytes.size(); at += kPoint) {
            Vec3 x;
            for (int axis = 0; axis < 3; ++axis)
                x[axis] = double(take<float>(&bytes[at + sizeof(float) * size_t(axis)]));
            if (moves)
                x = (x.transpose() * world.topLeftCorner<3, 3>() + world.bottomLeftCorner<1, 3>())
                        .transpose();
            positions.push_back(scale_ == 1.0 ? x : Vec3(scale_ * x));
        }
        return positions;
    }

private:
    [[noreturn]] void refuse(const std::string& why) const { throw InvalidInput(name_ + ": " + why); }

    std::int64_t frame_size() const { return kTransform + kPoint * std::int64_t(vertex_count); }

    static Transform transform(const std::string& frame)
    {
        Transform world;
        for (int k = 0; k < 16; ++k)
            world(k / 4, k % 4) = take<double>(&frame[sizeof(double) * size_t(k)]);
        return world;
    }

    /// The next bytes of what precedes the frames.
    std::string bytes(std::int64_t count)
    {
        if (count > size_ - at_)
            refuse("needs " + std::to_string(count) + " bytes at byte " + std::to_string(at_) +
                   " of what USD left, which has " + std::to_string(size_));
        std::string part(size_t(count), '\0');
        file_->read_at(at_, part.data(), part.size());
        at_ += count;
        return part;
    }

    template <typename T>
    T next()
    {
        return take<T>(bytes(sizeof(T)).data());
    }

    template <typename T>
    std::vector<T> next_array(int width = 1)
    {
        return values_of<T>(bytes(std::int64_t(next<std::uint32_t>()) * width * std::int64_t(sizeof(T))));
    }

    void read_head()
    {
        if (bytes(8) != "ToileUSD")
            refuse("what USD left does not start with ToileUSD");
        const auto points = next<std::uint32_t>(), frames = next<std::uint32_t>(),
                   samples = next<std::uint32_t>();
        const auto rate = next<double>(), start = next<double>(), metres = next<double>();
        const bool has_z_up = next<std::uint32_t>() == 1;
        is_clockwise_ = next<std::uint32_t>() == 1;
        scope_ = next<std::uint32_t>();
        constexpr std::int64_t kMax = INT32_MAX;
        if (points < 1 || frames < 1 || points > kMax / kPoint || frames > kMax)
            refuse("has " + std::to_string(points) + " points and " + std::to_string(frames) + " frames");
        if (!(rate > 0.0 && std::isfinite(rate)) || !(std::fabs(start) < kMaxStartFrame) || samples < 1 ||
            samples > std::uint32_t(kMaxSubframes))
            refuse("has " + std::to_string(rate) + " frames a second from frame " + std::to_string(start) +
                   " on, and " + std::to_string(samples) + " samples of each");
        if (!(metres > 0.0 && std::isfinite(metres)))
            refuse("has units of " + std::to_string(metres) + " m; they must be positive");
        vertex_count = int(points);
        frame_count = int(frames);
        subframes = int(samples);
        start_frame = start;
        if (frame_count > 1)
            fps = rate;
        const bool is_cm = std::fabs(metres - 0.01) < 1e-9;
        scale_ = is_cm || std::fabs(metres - 1.0) < 1e-9 ? 1.0 : metres;
        axes = Axes{is_cm ? "cm" : "m", has_z_up ? "z" : "y"};
    }

    void read_times()
    {
        times = next_array<double>();
        if (times.empty())
            return;
        if (int(times.size()) != frame_count)
            refuse("has " + std::to_string(times.size()) + " times of " + std::to_string(frame_count) +
                   " frames");
        if (const std::string fault = fault_of_times(times); !fault.empty())
            refuse(fault);
        fps.reset();
        start_frame = 0.0;
    }

    void read_faces()
    {
        const auto counts = next_array<std::int32_t>(), indices = next_array<std::int32_t>();
        mesh.polygons =
            polygons_of(counts, indices, vertex_count, [this](const std::string& why) { refuse(why); });
        corner_count_ = indices.size();
    }

    /// Texture coordinates of another number, or that are no numbers, are left out.
    void read_texture()
    {
        const std::vector<float> numbers = next_array<float>(2);
        const auto indices = next_array<std::int32_t>();
        const size_t expected = scope_ == kCorners  ? corner_count_
                                : scope_ == kPoints ? size_t(vertex_count)
                                                    : 0;
        const auto is_beyond = [&](std::int32_t k) { return k < 0 || size_t(k) >= numbers.size() / 2; };
        if (expected == 0 || indices.size() != expected ||
            std::any_of(indices.begin(), indices.end(), is_beyond) ||
            !std::all_of(numbers.begin(), numbers.end(), [](float x) { return std::isfinite(x); }))
            return;
        for (size_t k = 0; k + 1 < numbers.size(); k += 2)
            mesh.texture_coordinates.push_back(Vec2(numbers[k], numbers[k + 1]));
        size_t corner = 0;
        for (const std::vector<int>& polygon : mesh.polygons) {
            std::vector<int>& uvs = mesh.polygon_uvs.emplace_back();
            for (const int v : polygon)
                uvs.push_back(indices[scope_ == kCorners ? corner++ : size_t(v)]);
        }
    }

    /// A face in several groups is in the last.
    void read_groups()
    {
        std::vector<std::uint32_t> group_of(mesh.polygons.size(), 0); // 0: none
        std::vector<std::string> names{""};
        const auto count = next<std::uint32_t>();
        for (std::uint32_t g = 0; g < count; ++g) {
            names.push_back(bytes(next<std::uint32_t>()));
            for (const std::int32_t polygon : next_array<std::int32_t>())
                if (polygon >= 0 && size_t(polygon) < group_of.size())
                    group_of[size_t(polygon)] = g + 1;
        }
        for (size_t k = 0; k < group_of.size(); ++k)
            if (group_of[k] != (k == 0 ? 0 : group_of[k - 1]))
                begin_group(mesh, names[group_of[k]], int(k));
    }

    /// Makes the faces counter-clockwise; a mirror turns them once more.
    void finish_faces()
    {
        std::string first(size_t(kTransform), '\0');
        file_->read_at(first_frame_at_, first.data(), first.size());
        const bool mirrors = transform(first).topLeftCorner<3, 3>().determinant() < 0.0;
        if (is_clockwise_ != mirrors)
            for (auto* corners : {&mesh.polygons, &mesh.polygon_uvs})
                for (std::vector<int>& polygon : *corners)
                    std::reverse(polygon.begin(), polygon.end());
        mesh.positions = frame(0);
    }

    std::unique_ptr<const BinaryFile> file_;
    std::string name_;
    std::int64_t size_, at_ = 0, first_frame_at_ = 0;
    std::uint32_t scope_ = kNone;
    bool is_clockwise_ = false;
    size_t corner_count_ = 0;
    double scale_ = 1.0; ///< to metres, of units that Axes has none for
};

} // namespace

std::unique_ptr<const PointCache::Source> open_usd_frames(std::unique_ptr<const BinaryFile> file,
                                                          const std::string& name)
{
    return std::make_unique<UsdFrames>(std::move(file), name);
}

} // namespace toile::exports
