#include "scenes/surfaces/load_cloth.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <numbers>
#include <set>

#include "core/base/error.h"
#include "core/base/long_work.h"
#include "scenes/colliders/select_vertices.h"
#include "scenes/format/scene_fabric.h"
#include "scenes/meshes/cloth_mesh.h"
#include "scenes/meshes/rigid_motion.h"
#include "scenes/surfaces/cloth_elastics.h"
#include "scenes/surfaces/fold_edges.h"
#include "scenes/surfaces/load_soft_bodies.h"
#include "scenes/surfaces/load_solid.h"
#include "scenes/surfaces/paint.h"
#include "scenes/surfaces/uv_rest.h"

namespace toile::scenes {

namespace {

/// The warp of flat cloth is the X axis of its own frame, however it is placed. That of a garment is the
/// vertical in which it stands.
/// @param unmoved  [vertices] positions before the cloth's translation [m]
std::shared_ptr<const garment::RestShape>
rest_shape_of(std::vector<Vec3> unmoved, const std::vector<Triangle>& triangles, const scene::Cloth& settings)
{
    const Mat3 back = rotation_of(settings.rotate_deg).transpose();
    std::vector<Vec3> own = unmoved;
    for (Vec3& p : own)
        p = back * p;
    const Bounds box = bounds(own);
    const bool is_flat = box.upper.y() - box.lower.y() < 1e-9 * (1.0 + (box.upper - box.lower).norm());
    return std::make_shared<const garment::RestShape>(garment::rest_shape_of_surface(
        {is_flat ? std::move(own) : std::move(unmoved), triangles}, is_flat ? Vec3::UnitX() : Vec3::UnitY(),
        settings.grain_deg * std::numbers::pi / 180.0, source_of(settings)));
}

/// Takes the rest shape from the texture coordinates of a cloth that is not translated yet.
void rest_on_texture(const scene::Cloth& settings, LoadedCloth& loaded,
                     const std::function<void(const std::string&)>& warn)
{
    ClothState& state = loaded.state;
    UvRest uv = uv_rest(settings, settings.rest_file ? mesh_at_rest(settings) : state.rest);
    if (!settings.uv_scale)
        loaded.note = rest_source_of(settings) + ": " + scale_note(uv);
    if (const std::string text = mismatch_warning(uv); warn && !text.empty())
        warn(rest_source_of(settings) + ": " + text);
    state.panels = std::move(uv.triangles);
    loaded.rest = std::make_shared<const garment::RestShape>(garment::rest_shape_of_panels(
        {state.rest.positions, state.triangles}, state.panels, settings.grain_deg * std::numbers::pi / 180.0,
        rest_source_of(settings)));
}

/// Gives the triangles of groups their own fabrics.
/// @throws InvalidInput for a group that the file does not have
void take_groups(const Scene& scene, const scene::Cloth& settings, ClothState& state)
{
    if (settings.groups.empty())
        return;
    std::map<std::string, int> number; // of the fabrics
    for (const auto& [name, group] : settings.groups) {
        state.group_fabrics.push_back(fabric_of(scene, group));
        number[name] = int(state.group_fabrics.size());
    }
    std::set<std::string> found;
    auto group = state.rest.groups.begin();
    std::string name;
    for (int f = 0; f < int(state.rest.polygons.size()); ++f) {
        for (; group != state.rest.groups.end() && group->first_polygon == f; ++group)
            found.insert(name = group->name);
        const auto own = number.find(name);
        state.fabric_of_triangle.insert(state.fabric_of_triangle.end(), state.rest.triangles_of(f).size(),
                                        own == number.end() ? 0 : own->second);
    }
    for (const auto& [asked, group_settings] : settings.groups)
        if (!found.contains(asked)) {
            const std::string nearest = nearest_word(asked, {found.begin(), found.end()});
            throw InvalidInput(
                source_of(settings) + ": has no group \"" + asked + "\" for cloth \"" + settings.name + "\"" +
                (nearest.empty() ? "; name those of its g lines" : "; did you mean \"" + nearest + "\"?"));
        }
}

/// The selection with the cloth's numbers of vertices for those of the file.
scene::Selection in_cloth(scene::Selection select, const ClothState& cloth, const std::string& location)
{
    auto* vertices = std::get_if<std::vector<int>>(&select.by);
    if (vertices == nullptr)
        return select;
    for (int& v : *vertices)
        v = cloth.vertex_of_file(v, location, "attach vertices of the surface");
    return select;
}

/// Warns of points that select the vertex nearest to them from farther away than the cloth is large: they are
/// likely in another unit.
void warn_of_far_points(const scene::Attachment& attachment, const ClothState& cloth,
                        const std::string& location, const std::function<void(const std::string&)>& warn)
{
    const auto* points = std::get_if<std::vector<Vec3>>(&attachment.select.by);
    if (points == nullptr || !warn)
        return;
    const Bounds box = bounds(cloth.positions);
    for (size_t i = 0; i < points->size(); ++i) {
        const Vec3 inside = (*points)[i].cwiseMax(box.lower).cwiseMin(box.upper);
        const double distance = ((*points)[i] - inside).norm();
        if (distance <= box.diagonal())
            continue;
        char text[100];
        std::snprintf(text, sizeof text, ".select.nearest[%zu]: is %.3g m away from ", i, distance);
        warn(location + text + "\"" + cloth.name +
             "\"; coordinates are in metres, at the start of the scene");
    }
}

ClothState::Attachment load_attachment(const scene::Attachment& attachment, const ClothState& cloth,
                                       const std::vector<Collider>& colliders, const std::string& location)
{
    ClothState::Attachment loaded;
    loaded.vertices =
        select_vertices(in_cloth(attachment.select, cloth, location), cloth.positions, colliders);
    loaded.release = attachment.release.value_or(loaded.release);
    if (loaded.vertices.empty())
        throw InvalidInput(location + ": selects no vertex of \"" + cloth.name +
                           "\"; move the selection to where the cloth starts");
    return loaded;
}

/// Name of a cloth in errors: skirt.json: cloths[0].
std::string cloth_location(const Scene& scene, const scene::Cloth& cloth)
{
    const auto is_it = [&](const scene::Cloth& other) { return other.name == cloth.name; };
    const auto index = std::find_if(scene.cloths.begin(), scene.cloths.end(), is_it) - scene.cloths.begin();
    return scene.source.string() + ": cloths[" + std::to_string(index) + "]";
}

/// @param key_path  of the list, for messages
/// @throws InvalidInput for vertices that do not exist, and two that are one in the cloth
std::vector<garment::Tacks::Tack> tacks_of(const std::vector<scene::Tack>& tacks, const ClothState& cloth,
                                           const std::string& key_path)
{
    std::vector<garment::Tacks::Tack> result;
    for (size_t i = 0; i < tacks.size(); ++i) {
        const std::string location = key_path + "[" + std::to_string(i) + "]";
        const auto vertex = [&](int number, const char* key) {
            return cloth.vertex_of_file(number, location + key, "tack vertices of the surface");
        };
        result.push_back({vertex(tacks[i].a, ".a"), vertex(tacks[i].b, ".b"), tacks[i].close_at});
        if (result.back().a == result.back().b)
            throw InvalidInput(location + ": vertices " + std::to_string(tacks[i].a) + " and " +
                               std::to_string(tacks[i].b) + " are one point of \"" + cloth.name +
                               "\"; name two");
    }
    return result;
}

bool is_selected_near(const Scene& scene, const std::string& avatar)
{
    return std::any_of(scene.attachments.begin(), scene.attachments.end(), [&](const auto& attachment) {
        const auto* near = std::get_if<scene::SelectNearAvatar>(&attachment.select.by);
        return near != nullptr && near->avatar == avatar;
    });
}

/// True if a soft body fills the surface of this avatar.
bool is_filled(const Scene& scene, const std::string& avatar)
{
    return std::any_of(scene.soft_bodies.begin(), scene.soft_bodies.end(), [&](const scene::SoftBody& body) {
        return !body.file && body.core->avatar == avatar;
    });
}

} // namespace

LoadedCloth load_cloth(const Scene& scene, const scene::Cloth& settings,
                       const std::vector<Collider>& colliders,
                       const std::function<void(const std::string&)>& warn)
{
    LoadedCloth loaded;
    ClothState& state = loaded.state;
    state.name = settings.name;
    state.fabric = fabric_of(scene, settings);
    ClothMesh mesh = cloth_mesh(settings);
    for (const std::string& warning : mesh.warnings)
        if (warn)
            warn(source_of(settings) + ": " + warning);
    state.rest = std::move(mesh.mesh);
    state.numbers = std::move(mesh.numbers);
    state.file = std::move(mesh.file);
    state.triangles = state.rest.triangulated().triangles;
    take_groups(scene, settings, state);
    if (settings.painted)
        take_paint(*settings.painted, source_of(settings), state);
    if (settings.rest == scene::RestFrom::Uv)
        rest_on_texture(settings, loaded, warn);
    else
        loaded.rest = rest_shape_of(state.rest.positions, state.triangles, settings);
    const std::string location = cloth_location(scene, settings);
    loaded.elastics = elastic_springs(settings.elastics, state, *loaded.rest, location + ".elastics");
    for (ObjMesh* placed : {&state.rest, &state.file})
        for (Vec3& p : placed->positions)
            p += settings.translate;
    state.positions = state.rest.positions;
    loaded.folds = fold_edges(settings.folds, state, loaded.rest->topology, location + ".folds");
    loaded.tacks = tacks_of(settings.tacks, state, location + ".tacks");
    for (size_t i = 0; i < scene.attachments.size(); ++i)
        if (scene.attachments[i].cloth == settings.name) {
            const std::string of_attachment = attachment_location(scene, i);
            state.attachments.push_back(
                load_attachment(scene.attachments[i], state, colliders, of_attachment));
            warn_of_far_points(scene.attachments[i], state, of_attachment, warn);
        }
    return loaded;
}

std::string attachment_location(const Scene& scene, size_t attachment)
{
    return scene.source.string() + ": attachments[" + std::to_string(attachment) + "]";
}

std::vector<ClothState> load_surfaces(const Scene& scene)
{
    const std::size_t count =
        scene.avatars.size() + scene.cloths.size() + scene.solids.size() + scene.soft_bodies.size();
    std::size_t loaded = 0;
    std::vector<Collider> colliders;
    for (const scene::Avatar& avatar : scene.avatars) {
        const LongWork::Part part = LongWork::item(loaded++, count);
        if (is_selected_near(scene, avatar.name) || is_filled(scene, avatar.name))
            colliders.emplace_back(avatar, scene.contact.friction);
    }
    std::vector<ClothState> surfaces;
    for (const scene::Cloth& cloth : scene.cloths) {
        const LongWork::Part part = LongWork::item(loaded++, count);
        surfaces.push_back(load_cloth(scene, cloth, colliders, {}).state);
    }
    for (const scene::Solid& solid : scene.solids) {
        const LongWork::Part part = LongWork::item(loaded++, count);
        surfaces.push_back(load_solid(solid));
    }
    std::vector<LoadedSoftBody> soft_bodies = load_soft_bodies(scene.soft_bodies, colliders);
    for (LoadedSoftBody& body : soft_bodies) {
        const LongWork::Part part = LongWork::item(loaded++, count);
        surfaces.push_back(std::move(body.surface));
    }
    for (LoadedSoftBody& body : soft_bodies)
        if (body.render)
            surfaces.push_back(std::move(body.render->state));
    LongWork::update(1.0);
    return surfaces;
}

} // namespace toile::scenes
