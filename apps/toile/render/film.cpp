#include "apps/toile/render/film.h"

#include <algorithm>
#include <cmath>

#include "apps/toile/caches/cache_contents.h"
#include "apps/toile/check/cache_cloth.h"
#include "apps/toile/cloth/skin.h"
#include "apps/toile/render/body_paint.h"
#include "apps/toile/render/print.h"
#include "core/base/error.h"
#include "core/base/long_work.h"
#include "export/cache_path.h"
#include "export/times/resampled_cache.h"
#include "scenes/surfaces/load_cloth.h"
#include "scenes/world/world.h"

namespace toile::app {

namespace {

preview::Material body_material(const Vec3& srgb)
{
    preview::Material material;
    material.front = material.back = linear_color(srgb);
    return material;
}

/// What a mesh is called: /skirt/skirtShape of an archive, or the name of its file.
std::string name_in_cache(const std::filesystem::path& mesh)
{
    const std::filesystem::path inside = exports::mesh_path_of(mesh);
    return inside.has_parent_path() && inside.parent_path().has_filename()
               ? inside.parent_path().filename().string()
               : exports::archive_of(mesh).stem().string();
}

void require_name(const std::string& name, const std::vector<std::string>& known)
{
    if (std::find(known.begin(), known.end(), name) != known.end())
        return;
    std::string list;
    for (const std::string& word : known)
        list += (list.empty() ? "" : ", ") + word;
    const std::string near = nearest_word(name, known);
    throw InvalidInput("--target: nothing in the picture is named \"" + name + "\"; " +
                       (near.empty() ? "there are " + list + "; or write X,Y,Z in metres"
                                     : "did you mean \"" + near + "\"?"));
}

/// Part of the loading that is that of avatars [-].
constexpr double kOfBodies = 0.5;

std::vector<scenes::SceneBody> load_bodies(const scenes::Scene& scene)
{
    const LongWork::Part part(0.0, kOfBodies);
    return scenes::make_bodies(scene);
}

exports::PointCache at_regular_times(const exports::PointCache& cache, double fps,
                                     const std::filesystem::path& file)
{
    return cache.times().empty() ? cache : exports::resampled(cache, fps, file);
}

} // namespace

Film Film::of_scene(const scenes::Scene& scene, const scenes::WorldOptions& options)
{
    Film film;
    film.settings_ = scene;
    film.bodies_ = load_bodies(scene);
    film.frame_count_ = 1;
    const scenes::World world(scene, options);
    film.surfaces_.assign(world.surfaces().begin(), world.surfaces().end());
    for (int i = 0; i < int(film.surfaces_.size()); ++i)
        film.add_surface(i, std::nullopt, {});
    film.drop_replaced();
    return film;
}

Film Film::of_caches(const scenes::Scene& scene, const std::vector<std::filesystem::path>& caches,
                     const std::string& cloth, const scene::Export& unlisted)
{
    Film film;
    film.settings_ = scene;
    film.bodies_ = load_bodies(scene);
    const LongWork::Part part(kOfBodies, 1.0);
    film.surfaces_ = scenes::load_surfaces(scene);
    for (const std::filesystem::path& file : caches) {
        for (const ClothInCache& in_cache : cloths_of_cache(scene, file, cloth, unlisted)) {
            const scenes::ClothState& state = film.surfaces_[size_t(in_cache.surface)];
            const exports::PointCache cache =
                at_regular_times(open_cloth(file, in_cache.entry, state), scene.fps, file);
            require_same_points(cache, file, state.name, int(state.file_mesh().positions.size()));
            film.add_surface(in_cache.surface, cache, file);
        }
    }
    film.drop_replaced();
    return film;
}

Film Film::of_caches_with_faces(const std::vector<std::filesystem::path>& caches, const exports::Axes& axes)
{
    Film film;
    film.settings_.render.ground.reset();
    for (const std::filesystem::path& file : caches)
        for (const std::filesystem::path& mesh : exports::meshes_of_cache(file)) {
            const exports::PointCache cache =
                at_regular_times(exports::read_cache(mesh), film.settings_.fps, mesh);
            if (cache.mesh() == nullptr)
                throw InvalidInput(file.string() +
                                   ": has points without faces; give --scene with the scene that it " +
                                   "was made from");
            film.settings_.fps = cache.fps().value_or(film.settings_.fps) * cache.subframes();
            film.add_cloth(name_in_cache(mesh), {}, cache.mesh()->triangulated().triangles,
                           cache.mesh()->positions, cache, mesh);
            film.tracks_.back().axes = axes;
        }
    return film;
}

/// @param index  in surfaces_
void Film::add_surface(int index, std::optional<exports::PointCache> cache, const std::filesystem::path& file)
{
    const scenes::ClothState& state = surfaces_[size_t(index)];
    const int solid = index - int(settings_.cloths.size()), soft = solid - int(settings_.solids.size());
    const auto body =
        std::find_if(settings_.soft_bodies.begin(), settings_.soft_bodies.end(), [&](const auto& other) {
            return other.name == state.name || (other.render && other.render_name() == state.name);
        });
    const scene::Cloth settings = solid < 0 ? settings_.cloths[size_t(index)] : scene::Cloth{};
    add_cloth(state.name, settings, state.triangles, state.positions, std::move(cache), file);
    tracks_.back().cloth = &state;
    apply_print(settings, state, tracks_.back().mesh);
    if (solid >= 0)
        tracks_.back().mesh.material =
            body_material(soft < 0 ? settings_.solids[size_t(solid)].color : body->color);
}

/// Removes soft bodies whose render surfaces are in the film.
void Film::drop_replaced()
{
    const std::vector<std::string> shown = names();
    std::erase_if(tracks_, [&](const Track& track) {
        return std::any_of(settings_.soft_bodies.begin(), settings_.soft_bodies.end(), [&](const auto& body) {
            return body.render && body.name == track.name &&
                   std::find(shown.begin(), shown.end(), body.render_name()) != shown.end();
        });
    });
}

void Film::add_cloth(const std::string& name, const scene::Cloth& settings,
                     const std::vector<Triangle>& triangles, const std::vector<Vec3>& start,
                     std::optional<exports::PointCache> cache, const std::filesystem::path& file)
{
    Track track;
    track.name = name;
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
    std::vector<Vec3> x = track.cache->frame(shown);
    exports::change_axes(track.cache->axes().value_or(track.axes), {}, x);
    require_in_range(x, track.file.string() + ": frame " + std::to_string(shown));
    return track.cloth ? track.cloth->from_file(x) : x;
}

bool Film::is_shown(const scenes::SceneBody& body) const
{
    if (!settings_.render.ground || !std::holds_alternative<scene::Plane>(body.settings().shape))
        return true;
    constexpr double kSame = 1e-3; // [m], [-]: the picture's floor replaces a plane there
    const Vec3 up = body.pose().linear() * Vec3::UnitY();
    return (up - Vec3::UnitY()).norm() > kSame ||
           std::abs(body.pose().translation().y() - *settings_.render.ground) > kSame;
}

void Film::show_bodies(int frame)
{
    for (scenes::SceneBody& body : bodies_)
        body.advance_to(frame * settings_.frame_duration());
}

std::vector<std::string> Film::names() const
{
    std::vector<std::string> names;
    for (const Track& track : tracks_)
        names.push_back(track.name);
    for (const scenes::SceneBody& body : bodies_)
        if (!std::holds_alternative<scene::Plane>(body.settings().shape))
            names.push_back(body.settings().name);
    return names;
}

Bounds Film::bounds_of(int frame, const std::string& name)
{
    Bounds box;
    for (const Track& track : tracks_)
        if (name.empty() || track.name == name)
            for (const Vec3& p : positions(track, frame))
                box.extend(p);
    show_bodies(frame);
    for (const scenes::SceneBody& body : bodies_)
        if (!std::holds_alternative<scene::Plane>(body.settings().shape) &&
            (name.empty() || body.settings().name == name))
            for (const Vec3& p : body.surface().positions)
                box.extend(p);
    return box;
}

void Film::paint_bodies(const std::function<void(const std::string&)>& warn)
{
    paints_.clear();
    for (const scenes::SceneBody& body : bodies_)
        paints_.push_back(paint_of(body, warn));
}

std::vector<std::filesystem::path> Film::paint_files() const
{
    std::vector<std::filesystem::path> files;
    for (const std::shared_ptr<const preview::Paint>& paint : paints_)
        if (paint)
            files.insert(files.end(), paint->appearance().files.begin(), paint->appearance().files.end());
    return files;
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

std::vector<Film::Cloth> Film::cloths(int frame) const
{
    std::vector<Cloth> cloths;
    for (const Track& track : tracks_)
        if (is_cloth(track))
            cloths.push_back({int(track.cloth - surfaces_.data()), positions(track, frame)});
    return cloths;
}

TriangleMesh Film::skin(int frame)
{
    show_bodies(frame);
    return skin_of(bodies_);
}

TriangleMesh Film::solids(int frame) const
{
    TriangleMesh solids;
    for (const Track& track : tracks_)
        if (!is_cloth(track))
            append(solids, positions(track, frame), track.mesh.triangles);
    return solids;
}

bool Film::is_cloth(const Track& track) const
{
    return track.cloth != nullptr && track.cloth - surfaces_.data() < long(settings_.cloths.size());
}

void Film::choose(const std::vector<Shot>& shots, const CameraTarget& target, const preview::Crop& crop)
{
    const std::string* const name = std::get_if<std::string>(&target);
    if (name != nullptr)
        require_name(*name, names());
    std::vector<Bounds> boxes;
    for (size_t i = 0; i < shots.size(); ++i)
        boxes.push_back(i > 0 && shots[i].frame == shots[i - 1].frame
                            ? boxes.back()
                            : bounds_of(shots[i].frame, name != nullptr ? *name : ""));
    shots_ = shots;
    crop_ = crop;
    path_ = CameraPath(settings_.render, crop, target, shots, boxes, settings_.fps);
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
    for (size_t i = 0; i < bodies_.size(); ++i) {
        const scenes::SceneBody& body = bodies_[i];
        if (!is_shown(body))
            continue;
        preview::RenderMesh mesh;
        mesh.paint = paints_.empty() ? nullptr : paints_[i];
        mesh.positions = body.surface().positions;
        mesh.triangles = body.surface().triangles;
        mesh.material = body_material(body.settings().color);
        scene.meshes.push_back(std::move(mesh));
    }
    return scene;
}

preview::Image Film::picture(size_t shot)
{
    const int frame = shots_[shot].frame;
    show_bodies(frame);
    if (!renderer_) {
        const PictureSize size = picture_size();
        renderer_.emplace(render_scene(frame),
                          preview::RenderSettings{size.width, size.height, settings_.render.samples});
    } else if (rendered_frame_ != frame) {
        int mesh = 0;
        for (const Track& track : tracks_)
            renderer_->update(mesh++, positions(track, frame));
        for (const scenes::SceneBody& body : bodies_)
            if (is_shown(body))
                renderer_->update(mesh++, body.surface().positions);
    }
    rendered_frame_ = frame;
    return renderer_->render(path_.at(shot));
}

} // namespace toile::app
