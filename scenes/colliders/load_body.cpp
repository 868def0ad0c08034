#include "scenes/colliders/load_body.h"

#include <utility>

#include "avatars/model/cached_avatar.h"
#include "core/base/error.h"
#include "export/point_cache.h"
#include "export/times/frame_times.h"
#include "scenes/format/cache_files.h"
#include "scenes/format/field.h"
#include "scenes/meshes/mesh_file.h"

namespace toile::scenes {

namespace {

/// Times of the samples of a cache [s].
std::vector<double> times_of(const exports::PointCache& cache, const CacheSettings& settings,
                             const std::string& source)
{
    if (const std::string fault = exports::fault_of_times(cache.times()); !fault.empty())
        throw InvalidInput(source + ": " + fault + "; export it again");
    if (!cache.times().empty())
        return cache.times();
    if (!cache.fps() && !settings.fps && cache.frame_count() > 1)
        throw InvalidInput(source + ": has no times; give the avatar's fps");
    const double rate = cache.fps().value_or(settings.fps.value_or(1.0)) * cache.subframes();
    std::vector<double> times;
    times.reserve(size_t(cache.frame_count()));
    for (int k = 0; k < cache.frame_count(); ++k)
        times.push_back(k / rate);
    return times;
}

/// Faces of a cache: its own, or those of the mesh on which it plays.
TriangleMesh faces_of(const exports::PointCache& cache, const CacheSettings& settings,
                      const std::string& source)
{
    if (cache.mesh() == nullptr && !settings.mesh)
        throw InvalidInput(source + ": has no faces; name the OBJ on which it plays as the avatar's mesh");
    const ObjMesh mesh = cache.mesh() != nullptr ? *cache.mesh() : read_mesh_file(*settings.mesh).mesh;
    if (int(mesh.positions.size()) != cache.vertex_count())
        throw InvalidInput(settings.mesh->string() + ": has " + std::to_string(mesh.positions.size()) +
                           " vertices, but " + source + " " + std::to_string(cache.vertex_count()) +
                           "; name the mesh on which the cache plays");
    TriangleMesh faces = mesh.triangulated();
    avatars::require_surface(faces, cache.mesh() != nullptr ? source : settings.mesh->string());
    return faces;
}

std::unique_ptr<avatars::Avatar> load_cached_body(avatars::AvatarSettings settings, const CacheSettings& more)
{
    const std::string source = settings.file.string();
    const exports::PointCache cache = exports::read_cache(settings.file);
    if (cache.frame_count() < 1)
        throw InvalidInput(source + ": has no sample; a body needs one at least");
    if (settings.unit.empty() && cache.axes())
        settings.unit = cache.axes()->unit;
    if (settings.up.empty() && cache.axes())
        settings.up = cache.axes()->up;

    avatars::GeometryCache samples;
    samples.triangles = faces_of(cache, more, source).triangles;
    samples.vertex_count = cache.vertex_count();
    samples.times = times_of(cache, more, source);
    samples.positions = [cache](int sample) { return cache.frame(sample); };
    samples.metres_from_file = avatars::metres_from_file(settings);
    samples.turns_bones = more.turns_bones;
    auto body = std::make_unique<avatars::CachedAvatar>(source, std::move(samples));
    body->face_outwards();
    return body;
}

} // namespace

std::unique_ptr<avatars::Avatar> load_body(avatars::AvatarSettings settings, const CacheSettings& cache)
{
    return scene_format::is_cache(settings.file) ? load_cached_body(std::move(settings), cache)
                                                 : avatars::load_avatar(settings);
}

std::unique_ptr<avatars::Avatar> load_body(const scene::Avatar& settings)
{
    avatars::AvatarSettings body;
    if (const auto* file = std::get_if<std::filesystem::path>(&settings.shape))
        body.file = *file;
    else
        body.mannequin.height = std::get<scene::Mannequin>(settings.shape).height;
    if (settings.unit)
        body.unit = scene_format::word_of(*settings.unit);
    if (settings.up)
        body.up = scene_format::word_of(*settings.up);
    return load_body(std::move(body),
                     {settings.mesh, settings.fps, settings.self_contact == scene::SelfContact::Separate});
}

scene::LengthUnit unit_of_file(const scene::Avatar& settings)
{
    using enum scene::LengthUnit;
    if (settings.unit)
        return *settings.unit;
    const auto* file = std::get_if<std::filesystem::path>(&settings.shape);
    if (file == nullptr || !scene_format::is_cache(*file))
        return file != nullptr && avatars::is_in_centimetres(*file) ? Centimetre : Metre;
    const std::optional<exports::Axes> axes = exports::read_cache(*file).axes();
    return axes && axes->unit == "cm" ? Centimetre : Metre;
}

} // namespace toile::scenes
