#include "apps/toile/render/film.h"

#include <algorithm>
#include <cmath>

#include "apps/toile/caches/cache_contents.h"
#include "apps/toile/check/cache_cloth.h"
#include "apps/toile/render/print.h"
#include "core/base/error.h"
#include "core/base/long_work.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world.h"

namespace toile::app {

namespace {

/// Half width of the window that smooths the camera path [s]. Footsteps take about half a second; a shorter
/// window would make the camera bob with them.
constexpr double kFollowWindow = 0.5;

preview::Material body_material(const Vec3& srgb)
{
    preview::Material material;
    material.front = material.back = linear_color(srgb);
    return material;
}

/// Moving averages over `reach` entries to either side; windows are shorter at the ends.
std::vector<Vec3> smoothed(const std::vector<Vec3>& points, int reach)
{
    std::vector<Vec3> means;
    const int count = int(points.size());
    for (int i = 0; i < count; ++i) {
        const int half = std::min({reach, i, count - 1 - i});
        Vec3 sum = Vec3::Zero();
        for (int k = i - half; k <= i + half; ++k)
            sum += points[size_t(k)];
        means.push_back(sum / (2 * half + 1));
    }
    return means;
}

/// Part of the loading that is that of avatars [-].
constexpr double kOfBodies = 0.5;

std::vector<scenes::SceneBody> load_bodies(const scenes::Scene& scene)
{
    const LongWork::Part part(0.0, kOfBodies);
    return scenes::make_bodies(scene);
}

} // namespace

Film Film::of_scene(const scenes::Scene& scene, const scenes::WorldOptions& options)
{
    Film film;
    film.settings_ = scene;
    film.bodies_ = load_bodies(scene);
    film.frame_count_ = 1;
    const scenes::World world(scene, options);
    for (int i = 0; i < world.surfaces().size(); ++i)
        film.add_surface(i, world.surfaces()[i], std::nullopt, {});
    return film;
}

Film Film::of_caches(const scenes::Scene& scene, const std::vector<std::filesystem::path>& caches,
                     const std::string& cloth)
{
    Film film;
    film.settings_ = scene;
    film.bodies_ = load_bodies(scene);
    const LongWork::Part part(kOfBodies, 1.0);
    const std::vector<scenes::ClothState> surfaces = scenes::load_surfaces(scene);
    for (const std::filesystem::path& file : caches) {
        for (const ClothInCache& in_cache : cloths_of_cache(scene, file, cloth)) {
            const scenes::ClothState& state = surfaces[size_t(in_cache.surface)];
            const exports::PointCache cache = open_cloth(file, in_cache.entry, state);
            require_same_points(cache, file, state.name, int(state.file_mesh().positions.size()));
            film.add_surface(in_cache.surface, state, cache, file);
        }
    }
    return film;
}

Film Film::of_obj_caches(const std::vector<std::filesystem::path>& caches)
{
    Film film;
    film.settings_.render.ground.reset();
    for (const std::filesystem::path& file : caches)
        for (const std::filesystem::path& mesh : exports::meshes_of_cache(file)) {
            const exports::PointCache cache = exports::read_cache(mesh);
            if (cache.mesh() == nullptr)
                throw InvalidInput(file.string() +
                                   ": has points without faces; give --scene with the scene that it " +
                                   "was made from");
            film.settings_.fps = cache.fps().value_or(film.settings_.fps) * cache.subframes();
            film.add_cloth({}, cache.mesh()->triangulated().triangles, cache.mesh()->positions, cache, mesh);
        }
    return film;
}

/// @param index  in World::surfaces()
void Film::add_surface(int index, const scenes::ClothState& state, std::optional<exports::PointCache> cache,
                       const std::filesystem::path& file)
{
    const int solid = index - int(settings_.cloths.size());
    const scene::Cloth settings = solid < 0 ? settings_.cloths[size_t(index)] : scene::Cloth{};
    add_cloth(settings, state.triangles, state.positions, std::move(cache), file);
    tracks_.back().cloth = state;
    apply_print(settings, state, tracks_.back().mesh);
    if (solid >= 0)
        tracks_.back().mesh.material = body_material(settings_.solids[size_t(solid)].color);
}

void Film::add_cloth(const scene::Cloth& settings, const std::vector<Triangle>& triangles,
                     const std::vector<Vec3>& start, std::optional<exports::PointCache> cache,
                     const std::filesystem::path& file)
{
    Track track;
    track.file = file;
    if (cache)
        frame_count_ = std::max(frame_count_, cache->frame_count());
    track.cache = std::move(cache);
    track.start = start;
    track.mesh.triangles = triangles;
    track.mesh.material = preview::cloth_material(linear_color(settings.color));
    tracks_.push_back(std::move(track));
}

std::vector<Vec3> Film::positions(const Track& track, int frame) const
{
    if (!track.cache)
        return track.start;
    const int shown = std::min(frame, track.cache->frame_count() - 1);
    const std::vector<Vec3> x = track.cache->frame_in_metres(shown);
    require_in_range(x, track.file.string() + ": frame " + std::to_string(shown));
    return track.cloth ? track.cloth->from_file(x) : x;
}

bool Film::is_shown(const scenes::SceneBody& body) const
{
    // The picture's floor replaces a plane.
    return !(settings_.render.ground && std::holds_alternative<scene::Plane>(body.settings().shape));
}

void Film::show_bodies(int frame)
{
    for (scenes::SceneBody& body : bodies_)
        body.advance_to(frame * settings_.frame_duration());
}

Bounds Film::bounds_of(int frame)
{
    Bounds box;
    for (const Track& track : tracks_)
        for (const Vec3& p : positions(track, frame))
            box.extend(p);
    show_bodies(frame);
    for (const scenes::SceneBody& body : bodies_)
        if (!std::holds_alternative<scene::Plane>(body.settings().shape))
            for (const Vec3& p : body.surface().positions)
                box.extend(p);
    return box;
}

void Film::put_floor_below_avatars()
{
    show_bodies(0);
    Bounds box;
    for (const scenes::SceneBody& body : bodies_)
        for (const Vec3& p : body.surface().positions)
            box.extend(p);
    if (settings_.render.ground && !bodies_.empty())
        settings_.render.ground = box.lower.y();
}

void Film::choose(const std::vector<int>& frames)
{
    frames_ = frames;
    std::vector<Bounds> boxes;
    centers_.clear();
    for (const int frame : frames) {
        boxes.push_back(bounds_of(frame));
        const Vec3 center = boxes.back().center();
        centers_.push_back(Vec3(center.x(), 0.0, center.z()));
    }
    const int spacing = frames.size() > 1 ? frames[1] - frames[0] : 1;
    centers_ = smoothed(centers_, int(kFollowWindow * settings_.fps / spacing));

    view_ = Bounds();
    for (size_t i = 0; i < boxes.size(); ++i) {
        view_.extend(boxes[i].lower - centers_[i]);
        view_.extend(boxes[i].upper - centers_[i]);
    }
    renderer_.reset();
}

preview::RenderScene Film::render_scene(int frame) const
{
    preview::RenderScene scene;
    scene.ground_height = settings_.render.ground;
    for (const Track& track : tracks_) {
        scene.meshes.push_back(track.mesh);
        scene.meshes.back().positions = positions(track, frame);
    }
    for (const scenes::SceneBody& body : bodies_) {
        if (!is_shown(body))
            continue;
        preview::RenderMesh mesh;
        mesh.positions = body.surface().positions;
        mesh.triangles = body.surface().triangles;
        mesh.material = body_material(body.settings().color);
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

preview::Image Film::picture(int frame)
{
    const scene::Render& render = settings_.render;
    show_bodies(frame);
    if (!renderer_) {
        renderer_.emplace(render_scene(frame),
                          preview::RenderSettings{render.width, render.height, render.samples});
    } else {
        int mesh = 0;
        for (const Track& track : tracks_)
            renderer_->update(mesh++, positions(track, frame));
        for (const scenes::SceneBody& body : bodies_)
            if (is_shown(body))
                renderer_->update(mesh++, body.surface().positions);
    }

    preview::CameraSettings view;
    view.azimuth_deg = render.azimuth_deg;
    view.elevation_deg = render.elevation_deg;
    view.zoom = render.zoom;
    preview::Camera camera = fit_camera(preview::corners(view_), view, double(render.width) / render.height);
    const auto at = std::find(frames_.begin(), frames_.end(), frame) - frames_.begin();
    camera.origin += centers_[size_t(at)];
    return renderer_->render(camera);
}

} // namespace toile::app
