#include "apps/toile/check/certify.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "apps/toile/caches/exports.h"
#include "apps/toile/check/avatar_crossings.h"
#include "apps/toile/check/cache_cloth.h"
#include "apps/toile/check/penetration.h"
#include "apps/toile/cloth/strain.h"
#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/setup_progress.h"
#include "collision/check/find_crossings.h"
#include "collision/check/gap_meter.h"
#include "core/base/cancellation.h"
#include "core/base/error.h"
#include "core/base/long_work.h"
#include "scenes/format/field.h"

namespace toile::app {

namespace {

/// Distance [m] by which joined vertices of a cache may differ. Single precision has such steps at 1 km.
constexpr double kTear = 1e-4;

double area_of(View<const Vec3> x, View<const Triangle> triangles)
{
    double twice = 0.0;
    for (const Triangle& t : triangles)
        twice += (x[t[1]] - x[t[0]]).cross(x[t[2]] - x[t[0]]).norm();
    return 0.5 * twice;
}

/// Volume inside a closed surface, by the divergence theorem [m^3].
double volume_in(View<const Vec3> x, View<const Triangle> triangles)
{
    const Vec3& origin = x[triangles[0][0]]; // near, so that little cancels
    double volume = 0.0;
    for (const Triangle& t : triangles)
        volume += (x[t[0]] - origin).dot((x[t[1]] - origin).cross(x[t[2]] - origin)) / 6.0;
    return volume;
}

/// Triangles of one fabric.
struct StrainPart {
    std::vector<Triangle> triangles;
    StrainMeter meter;
    double limit; ///< [-] the margin included
};

/// @param margin  [-] beyond the fabrics' limits
std::vector<StrainPart> strain_parts_of(const scenes::ClothState& cloth, double margin)
{
    const auto part = [&](const std::vector<int>& numbers, double limit) {
        std::vector<Triangle> triangles;
        std::vector<FlatTriangle> panels;
        for (const int t : numbers) {
            triangles.push_back(cloth.triangles[size_t(t)]);
            if (!cloth.panels.empty())
                panels.push_back(cloth.panels[size_t(t)]);
        }
        StrainMeter meter =
            panels.empty() ? StrainMeter(cloth.rest.positions, triangles) : StrainMeter(panels, triangles);
        return StrainPart{std::move(triangles), std::move(meter), limit + margin};
    };
    const std::vector<std::vector<int>> numbers = cloth.triangles_by_fabric();
    std::vector<StrainPart> parts;
    for (size_t f = 0; f < numbers.size(); ++f)
        if (!numbers[f].empty() && std::isfinite(cloth.fabrics()[f].strain_limit))
            parts.push_back(part(numbers[f], cloth.fabrics()[f].strain_limit));
    return parts;
}

/// A cloth with its strain meters and samples.
struct MeasuredCloth {
    const scenes::ClothState& state;
    exports::PointCache cache;
    std::vector<StrainPart> strain; ///< by fabric
    collision::ClothSamples samples;
    int first_vertex, first_triangle;                      ///< in the arrays of all cloths
    std::vector<collision::PenetrationMeter::Sides> sides; ///< [avatars]
    std::optional<size_t> soft_body;                       ///< none: a cloth or solid
    double rest_volume = 0.0;                              ///< [m^3] of a soft body
};

/// Number of a soft body; none: the name is of a cloth or solid.
std::optional<size_t> soft_body_named(const scenes::Scene& scene, const std::string& name)
{
    for (size_t i = 0; i < scene.soft_bodies.size(); ++i)
        if (scene.soft_bodies[i].name == name)
            return i;
    return std::nullopt;
}

/// All cloths of a certificate as one list of triangles.
class Examiner {
public:
    Examiner(const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
             const CertificateLimits& limits);

    int frame_count() const { return frame_count_; } ///< of the shortest cache
    int longest() const { return longest_; }
    const std::vector<MeasuredCloth>& cloths() const { return cloths_; }

    FrameFindings examine(int frame, double time);

private:
    void load(int frame, FrameFindings& found);
    void pose_avatars(int frame, double time, FrameFindings& found);
    void measure_each(double time, FrameFindings& found);
    void measure_volumes(FrameFindings& found) const;
    void find_cloth_crossings(int frame, FrameFindings& found) const;
    void find_all_avatar_crossings(int frame, FrameFindings& found) const;
    FrameFindings::Side side(int triangle) const;
    FrameFindings::Side avatar_side(int body, int contact_triangle) const;

    std::vector<MeasuredCloth> cloths_;
    size_t soft_body_count_;
    int frame_count_ = 0, longest_ = 0;
    std::vector<Triangle> triangles_; ///< of all cloths
    std::vector<Vec3> x_;             ///< [vertices of all cloths] [m]
    std::vector<Vec3> last_x_;        ///< likewise, of the last frame
    std::optional<collision::GapMeter> gap_;
    ScenePenetration avatars_;
};

Examiner::Examiner(const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
                   const CertificateLimits& limits)
    : soft_body_count_(scene.soft_bodies.size()), avatars_(scene)
{
    std::vector<Vec3> rest;
    for (const CachedCloth& cached : cloths) {
        const scenes::ClothState& cloth = *cached.cloth;
        const int vertex_count = int(cloth.rest.positions.size());
        const exports::PointCache& cache = cached.cache;
        require_same_points(cache, cached.file, cloth.name, int(cloth.file_mesh().positions.size()));
        require_same_times(cache, cached.file, scene.fps, scene.frames);
        frame_count_ = cloths_.empty() ? cache.frame_count() : std::min(frame_count_, cache.frame_count());
        longest_ = std::max(longest_, cache.frame_count());
        cloths_.push_back({cloth,
                           cache,
                           strain_parts_of(cloth, limits.strain_margin),
                           collision::ClothSamples(cloth.triangles, vertex_count),
                           int(rest.size()),
                           int(triangles_.size()),
                           {},
                           soft_body_named(scene, cloth.name)});
        if (cloths_.back().soft_body)
            cloths_.back().rest_volume = volume_in(cloth.rest.positions, cloth.triangles);
        for (const Triangle& t : cloth.triangles)
            triangles_.push_back(t + Triangle::Constant(int(rest.size())));
        rest.insert(rest.end(), cloth.rest.positions.begin(), cloth.rest.positions.end());
    }
    gap_.emplace(triangles_, rest);
    x_.resize(rest.size());
}

void Examiner::load(int frame, FrameFindings& found)
{
    for (const MeasuredCloth& cloth : cloths_) {
        const std::vector<Vec3> stored = cloth.cache.frame_in_metres(frame);
        const std::vector<Vec3> positions = cloth.state.from_file(stored);
        std::copy(positions.begin(), positions.end(), x_.begin() + cloth.first_vertex);
        found.out_of_range += int(std::count_if(stored.begin(), stored.end(), std::not_fn(is_in_range)));
        if (!cloth.state.has_file_order())
            continue;
        const std::vector<Vec3> expected = cloth.state.to_file(positions);
        for (size_t v = 0; v < stored.size(); ++v)
            found.torn += (stored[v] - expected[v]).norm() > kTear ? 1 : 0;
    }
}

FrameFindings Examiner::examine(int frame, double time)
{
    std::swap(last_x_, x_);
    x_.resize(last_x_.size());
    FrameFindings found;
    load(frame, found);
    if (found.out_of_range > 0)
        return found;
    pose_avatars(frame, time, found);
    Cancellation::check();
    measure_each(time, found);
    measure_volumes(found);
    Cancellation::check();
    find_cloth_crossings(frame, found);
    Cancellation::check();
    find_all_avatar_crossings(frame, found);
    Cancellation::check();
    return found;
}

/// Poses the avatars, and finds cloth that passed through them.
void Examiner::pose_avatars(int frame, double time, FrameFindings& found)
{
    std::vector<collision::ClothFrames> frames;
    if (frame > 0 && std::all_of(last_x_.begin(), last_x_.end(), is_in_range))
        for (const MeasuredCloth& cloth : cloths_) {
            const int count = int(cloth.state.rest.positions.size());
            frames.emplace_back(cloth.samples, View<const Vec3>(last_x_).subview(cloth.first_vertex, count),
                                View<const Vec3>(x_).subview(cloth.first_vertex, count));
        }
    const std::vector<AvatarPassage> passages = avatars_.advance_to(time, frames);
    for (const AvatarPassage& at : passages) {
        if (at.passage.is_pinched) {
            ++found.pinched_passages;
            continue;
        }
        if (found.passages++ > 0)
            continue;
        const MeasuredCloth& cloth = cloths_[size_t(at.cloth)];
        found.passage = {frame, cloth.state.name, cloth.samples.name(at.passage.sample),
                         avatars_.bodies()[size_t(at.body)].settings().name, at.passage.point};
    }
}

/// @param x, attached  [vertices of its cloth]
void measure_strain(const StrainPart& part, View<const Vec3> x, View<const unsigned char> attached,
                    FrameFindings& found)
{
    const StrainMeter::Largest strain = part.meter.largest(x, attached);
    found.attached_strain = std::max(found.attached_strain, strain.of_attached);
    if (strain.free_triangle < 0)
        return;
    const Triangle& t = part.triangles[size_t(strain.free_triangle)];
    const Vec3 point = (x[t[0]] + x[t[1]] + x[t[2]]) / 3.0;
    if (strain.of_free > found.strain) {
        found.strain = strain.of_free;
        found.strain_point = point;
    }
    const auto excess = [](const FrameFindings::Overstretch& at) { return at.strain - at.limit; };
    const FrameFindings::Overstretch here{strain.of_free, part.limit, point};
    if (excess(here) > (found.overstretch ? excess(*found.overstretch) : 0.0))
        found.overstretch = here;
}

void Examiner::measure_each(double time, FrameFindings& found)
{
    for (MeasuredCloth& cloth : cloths_) {
        const int vertex_count = int(cloth.state.rest.positions.size());
        const View<const Vec3> x(x_.data() + cloth.first_vertex, vertex_count);
        const ScenePenetration::Depth depth =
            avatars_.measure(x, cloth.state.triangles, cloth.samples, cloth.sides);
        if (depth.deepest > found.penetration) {
            found.penetration = depth.deepest;
            found.penetration_point = depth.point;
        }
        found.pinched_depth = std::max(found.pinched_depth, depth.pinched);
        double rest_area = 0.0;
        const std::vector<unsigned char> attached = cloth.state.attached(time);
        for (const StrainPart& part : cloth.strain) {
            measure_strain(part, x, attached, found);
            rest_area += part.meter.rest_area();
        }
        found.area = std::min(found.area, area_of(x, cloth.state.triangles) / rest_area);
    }
}

void Examiner::measure_volumes(FrameFindings& found) const
{
    found.volumes.resize(soft_body_count_);
    for (const MeasuredCloth& cloth : cloths_) {
        if (!cloth.soft_body)
            continue;
        const View<const Vec3> x(x_.data() + cloth.first_vertex, int(cloth.state.rest.positions.size()));
        found.volumes[*cloth.soft_body] = volume_in(x, cloth.state.triangles) / cloth.rest_volume;
    }
}

void Examiner::find_cloth_crossings(int frame, FrameFindings& found) const
{
    const std::vector<collision::Crossing> crossings = collision::find_crossings(triangles_, x_);
    found.cloth_cloth_crossings = int(crossings.size());
    if (const auto gap = gap_->measure(x_, kGapReach))
        found.gap = gap->distance;
    if (crossings.empty())
        return;
    const collision::Crossing& first = crossings.front();
    found.crossing = {frame, side(first.a), side(first.b), first.point};
    found.gap = 0.0;
}

void Examiner::find_all_avatar_crossings(int frame, FrameFindings& found) const
{
    const AvatarCrossings crossings = find_avatar_crossings(avatars_, triangles_, x_);
    found.cloth_avatar_crossings = int(crossings.clean.size());
    found.pinched_crossings = int(crossings.pinched.size());
    if (!crossings.pinched.empty()) {
        const auto& [pinching, at] = crossings.pinched.front();
        found.pinch = {frame, side(at.a), avatar_side(pinching, at.b), at.point};
    }
    if (crossings.clean.empty() || found.crossing)
        return;
    const auto& [body, first] = crossings.clean.front();
    found.crossing = {frame, side(first.a), avatar_side(body, first.b), first.point};
}

FrameFindings::Side Examiner::avatar_side(int body, int contact_triangle) const
{
    const scenes::SceneBody& avatar = avatars_.bodies()[size_t(body)];
    const int face = avatar.face_of(contact_triangle);
    return {avatar.settings().name, face, avatar.bone_of(face)};
}

/// Cloth that owns a triangle of triangles_.
FrameFindings::Side Examiner::side(int triangle) const
{
    size_t k = cloths_.size() - 1;
    while (cloths_[k].first_triangle > triangle)
        --k;
    return {cloths_[k].state.name, triangle - cloths_[k].first_triangle};
}

Examiner load_examiner(const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
                       const CertificateLimits& limits, const RunLog& log)
{
    SetupProgress progress(log.quiet(), log.scene(), log.use());
    const LongWork::Scope loading(
        [&](const LongWork::Progress& now) { progress.update("loading for the check", now.fraction); });
    return {scene, cloths, limits};
}

Certificate blank_certificate(const scenes::Scene& scene, const CertificateLimits& limits)
{
    Certificate certificate;
    certificate.scene = scene.source;
    certificate.exports = exports_of(scene);
    certificate.solver = scene_format::word_of(scene.solver.method);
    certificate.limits = limits;
    certificate.frames_expected = scene.frames;
    certificate.fps = scene.fps;
    for (const scene::Avatar& avatar : scene.avatars)
        if (!avatar.exclude_bones.empty())
            certificate.excluded_bones[avatar.name] = avatar.exclude_bones;
    for (const scene::SoftBody& body : scene.soft_bodies)
        certificate.soft_bodies.emplace_back().name = body.name;
    return certificate;
}

/// [-] of all fabrics of a cloth
double largest_limit(const scenes::ClothState& cloth)
{
    double largest = 0.0;
    for (const garment::Fabric& fabric : cloth.fabrics())
        largest = std::max(largest, fabric.strain_limit);
    return largest;
}

/// States what is examined and what is left out.
void describe(Certificate& certificate, const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
              const Examiner& examiner)
{
    certificate.frames_left_out = examiner.longest() - examiner.frame_count();
    for (size_t i = 0; i < cloths.size(); ++i)
        certificate.cloths.push_back({cloths[i].cloth->name, cloths[i].file,
                                      largest_limit(*cloths[i].cloth) + certificate.limits.strain_margin,
                                      int(cloths[i].cloth->file_mesh().positions.size()),
                                      int(cloths[i].cloth->file_mesh().polygons.size())});
    std::vector<std::string> names = scenes::surface_names(scene);
    names.resize(size_t(simulated_count(scene)));
    for (const std::string& name : names)
        if (std::none_of(cloths.begin(), cloths.end(),
                         [&](const CachedCloth& cached) { return cached.cloth->name == name; }))
            certificate.left_out.push_back(name);
}

} // namespace

std::optional<Certificate> certify(const scenes::Scene& scene, const std::vector<CachedCloth>& cloths,
                                   const CertificateLimits& limits, const RunLog& log,
                                   const InterruptGuard& interrupt)
{
    const std::function<bool()> goes_on = [&] { return !interrupt.requested(); };
    const Cancellation::Scope cancellation(goes_on);
    Certificate certificate = blank_certificate(scene, limits);
    try {
        Examiner examiner = load_examiner(scene, cloths, limits, log);
        describe(certificate, scene, cloths, examiner);
        Progress progress = log.progress("check", examiner.frame_count());
        for (int frame = 0; frame < examiner.frame_count(); ++frame) {
            certificate.add(examiner.examine(frame, frame * scene.frame_duration()));
            progress.update(frame + 1);
        }
    } catch (const Cancelled&) {
        return std::nullopt;
    }
    return certificate;
}

int conclude(const Certificate& certificate, const std::filesystem::path& file, const RunLog& log)
{
    if (!certificate.holds())
        log.error(summary_of(certificate) + "; see " + file.string());
    else
        log.result(summary_of(certificate));
    return certificate.holds() ? kExitOk : kExitFailure;
}

std::filesystem::path certificate_beside(const std::filesystem::path& cache)
{
    return cache.parent_path() / (cache.stem().string() + "." + kCertificateName);
}

} // namespace toile::app
