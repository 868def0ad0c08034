#include "avatars/model/cached_avatar.h"

#include <algorithm>
#include <numeric>
#include <set>

#include "core/base/error.h"
#include "core/compute/parallel.h"
#include "core/mesh/point_text.h"
#include "core/mesh/triangle_mesh.h"
#include "core/time/sample_times.h"

namespace toile::avatars {

namespace {

/// Edges from a vertex to those over which its rotation is averaged.
constexpr int kRings = 4;

std::vector<Avatar::ClipName> clip_of(const GeometryCache& cache)
{
    if (cache.times.size() < 2)
        return {};
    return {{CachedAvatar::kClip, cache.times.back() - cache.times.front()}};
}

/// Right-handed axes: tangential along the edge, tangential across it, normal. The identity where there are
/// none.
Mat3 frame_of(const Vec3& normal, const Vec3& edge)
{
    const Vec3 along = edge - normal.dot(edge) * normal;
    const double length = along.norm();
    if (normal.isZero(0.0) || !(length > 0.0))
        return Mat3::Identity();
    Mat3 frame;
    frame.col(0) = along / length;
    frame.col(1) = normal.cross(frame.col(0));
    frame.col(2) = normal;
    return frame;
}

/// x + u (y - x)
void blend(double u, const std::vector<Vec3>& y, std::vector<Vec3>& x)
{
    for (size_t v = 0; v < x.size(); ++v)
        x[v] += u * (y[v] - x[v]);
}

} // namespace

CachedAvatar::CachedAvatar(std::string source, GeometryCache cache)
    : Avatar(std::move(source), std::move(cache.triangles), cache.vertex_count, clip_of(cache)),
      cache_(std::move(cache)), origins_(size_t(cache_.vertex_count), Vec3::Zero()),
      first_(origins_.size() + 1)
{
    std::iota(first_.begin(), first_.end(), 0);
    for (int v = 0; v < vertex_count(); ++v)
        influences_.push_back({v, 1.0});
    if (!cache_.turns_bones)
        return;
    list_neighbours();
    choose_anchors();
    rest_frames_ = frames(*sample(0));
}

void CachedAvatar::list_neighbours()
{
    std::vector<std::set<int>> ring(origins_.size());
    for (const Triangle& t : triangles())
        for (int k = 0; k < 3; ++k) {
            ring[size_t(t[k])].insert(t[(k + 1) % 3]);
            ring[size_t(t[k])].insert(t[(k + 2) % 3]);
        }
    first_neighbour_.push_back(0);
    for (const std::set<int>& of_vertex : ring) {
        neighbours_.insert(neighbours_.end(), of_vertex.begin(), of_vertex.end());
        first_neighbour_.push_back(int(neighbours_.size()));
    }
}

void CachedAvatar::choose_anchors()
{
    const Positions& x = *sample(0);
    const std::vector<Vec3> normals = vertex_normals(x, triangles());
    for (size_t v = 0; v < x.size(); ++v) {
        anchor_.push_back(-1);
        double largest = 0.0;
        for (int k = first_neighbour_[v]; k < first_neighbour_[v + 1]; ++k) {
            const Vec3 edge = (x[size_t(neighbours_[size_t(k)])] - x[v]).normalized();
            if (const double sine = normals[v].cross(edge).norm(); sine > largest) {
                largest = sine;
                anchor_.back() = neighbours_[size_t(k)];
            }
        }
    }
}

CachedAvatar::Positions CachedAvatar::read(int index) const
{
    Positions x = cache_.positions(index);
    if (int(x.size()) != cache_.vertex_count)
        throw InvalidInput(source() + ": sample " + std::to_string(index) + " has " +
                           std::to_string(x.size()) + " vertices and the mesh " +
                           std::to_string(cache_.vertex_count) + "; a body keeps its vertices");
    for (size_t v = 0; v < x.size(); ++v) {
        const Vec3 stored = x[v];
        x[v] = apply(cache_.metres_from_file, stored);
        if (!is_in_range(x[v]))
            throw InvalidInput(source() + ": vertex " + std::to_string(v) + " of sample " +
                               std::to_string(index) + " is at " + point_text(stored) +
                               "; coordinates must be finite and at most 100 km; export it again");
    }
    return x;
}

std::shared_ptr<const CachedAvatar::Positions> CachedAvatar::sample(int index)
{
    const auto known = std::find_if(samples_.begin(), samples_.end(),
                                    [&](const Sample& sample) { return sample.index == index; });
    if (known != samples_.end()) {
        std::rotate(known, known + 1, samples_.end());
        return samples_.back().x;
    }
    if (int(samples_.size()) == kSamples)
        samples_.erase(samples_.begin());
    samples_.push_back({index, std::make_shared<const Positions>(read(index))});
    return samples_.back().x;
}

CachedAvatar::Positions CachedAvatar::at(const PoseAt& at)
{
    if (at.clip < 0 || at.bind_weight >= 1.0)
        return *sample(0);
    const SamplePlace place = place_in(cache_.times, cache_.times.front() + at.time);
    Positions x = *sample(place.sample);
    if (place.part > 0.0)
        blend(place.part, *sample(place.sample + 1), x);
    if (at.bind_weight > 0.0)
        blend(at.bind_weight, *sample(0), x);
    return x;
}

/// Frames in the surface. [vertices]
std::vector<Mat3> CachedAvatar::frames(const Positions& x) const
{
    const std::vector<Vec3> normals = vertex_normals(x, triangles());
    std::vector<Mat3> frames(x.size());
    parallel_for(kCpu, "avatars/cache_turns", vertex_count(), [&](int v) {
        const int anchor = anchor_[size_t(v)];
        const Vec3 edge = anchor < 0 ? Vec3::Zero() : Vec3(x[size_t(anchor)] - x[size_t(v)]);
        frames[size_t(v)] = frame_of(normals[size_t(v)], edge);
    });
    return frames;
}

/// Rotations from sample 0, averaged over the vertices around: skin in folds turns by more than the limb that
/// it is on. [vertices]
std::vector<Mat3> CachedAvatar::turns(const Positions& x) const
{
    std::vector<Mat3> turns = frames(x);
    for (size_t v = 0; v < turns.size(); ++v)
        turns[v] *= rest_frames_[v].transpose();
    for (int ring = 0; ring < kRings; ++ring) {
        const std::vector<Mat3> before = turns;
        parallel_for(kCpu, "avatars/cache_turns", vertex_count(), [&](int v) {
            const int first = first_neighbour_[size_t(v)], end = first_neighbour_[size_t(v) + 1];
            for (int k = first; k < end; ++k)
                turns[size_t(v)] += before[size_t(neighbours_[size_t(k)])];
            turns[size_t(v)] /= 1 + end - first;
        });
    }
    return turns;
}

void CachedAvatar::pose_bones(const PoseAt& at, const Affine& world_from_avatar, View<Affine> bones)
{
    const Positions x = this->at(at);
    const std::vector<Mat3> turns = cache_.turns_bones ? this->turns(x) : std::vector<Mat3>{};
    parallel_for(kCpu, "avatars/cache", vertex_count(), [&](int v) {
        bones[v].leftCols<3>() = world_from_avatar.leftCols<3>();
        if (cache_.turns_bones)
            bones[v].leftCols<3>() *= turns[size_t(v)];
        bones[v].col(3) = apply(world_from_avatar, x[size_t(v)]);
    });
}

} // namespace toile::avatars
