#include "scenes/format/checks/checks.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/extension.h"
#include "export/cache_format.h"
#include "garment/fabric/fabric.h"
#include "scenes/format/cache_files.h"
#include "scenes/format/checks/body_checks.h"
#include "scenes/format/checks/export_checks.h"
#include "scenes/format/field.h"
#include "scenes/format/names.h"
#include "scenes/format/scene_fabric.h"
#include "scenes/format/solver_methods.h"

namespace toile::scene_format {

namespace {

using namespace scene;

/// Maximum number of vertices of one generated cloth; more is probably a typing error.
constexpr double kMaxVertices = 5e6;

/// For messages about bodies.
constexpr const char* kCaches = "a cache (.abc, .usda, .usdc, .pc2, .mdd, or a sequence of .obj or .ply)";

void check_keyframes(const Document& document, const std::string& key_path,
                     const std::vector<Keyframe>& frames)
{
    for (size_t i = 1; i < frames.size(); ++i)
        if (frames[i].time <= frames[i - 1].time)
            document.refuse(below(below(below(key_path, "keyframes"), i), "time"),
                            as_written(frames[i].time) + " s does not follow " +
                                as_written(frames[i - 1].time) +
                                " s; put keyframes in ascending order of time");
}

/// Likewise, for files that may be caches.
void check_extension_or_cache(const Document& document, const std::string& key_path,
                              const std::filesystem::path& file, std::vector<std::string> known)
{
    if (is_cache(file))
        return;
    known.emplace_back(kCaches);
    if (!contains(known, lower_case_extension(file)))
        document.refuse(key_path, as_written(file.string()) + " is of an unknown format; use " +
                                      enumerate(known, "or"));
}

/// Checks the file of a mesh with faces.
void check_shape_file(const Document& document, const std::string& key_path,
                      const std::filesystem::path& file)
{
    if (!is_cache(file))
        check_extension(document, key_path, file, {".obj", ".ply", ".abc", ".usda", ".usdc"});
    else if (!exports::features_of(exports::cache_format(file)).faces)
        document.refuse(key_path,
                        as_written(file.string()) + " has no faces; name the OBJ on which it plays");
}

// --- avatars ---

const std::filesystem::path* file_of(const Avatar& avatar)
{
    return std::get_if<std::filesystem::path>(&avatar.shape);
}

bool plays_cache(const Avatar& avatar) { return file_of(avatar) != nullptr && is_cache(*file_of(avatar)); }

void check_motion_file(const Document& document, const std::string& key_path, const Avatar& avatar)
{
    const AvatarMotion& motion = *avatar.motion;
    check_extension(document, below(key_path, "file"), motion.file, {".bvh", ".fbx", ".glb", ".gltf"});
    const std::filesystem::path* body = file_of(avatar);
    if (plays_cache(avatar) || (body != nullptr && lower_case_extension(*body) == ".obj"))
        document.refuse(key_path, std::string(plays_cache(avatar) ? "a cache" : "an .obj body") +
                                      " has no bones; use a .glb, .gltf or .fbx body");
    if (!avatar.clip.empty())
        document.refuse(key_path, "excludes clip; remove one of them");
    if (motion.is_mapped_by_file() && lower_case_extension(motion.map) != ".json")
        document.refuse(below(key_path, "map"),
                        as_written(motion.map) + " is unknown; write \"names\", \"cmu\" " +
                            "or the path of a .json file" + did_you_mean(motion.map, {"names", "cmu"}));
}

/// Checks keys that only caches support.
void check_cache(const Document& document, const std::string& key_path, const Avatar& avatar)
{
    if (!plays_cache(avatar)) {
        for (const auto& [key, is_used] :
             {std::pair("mesh", avatar.mesh.has_value()), std::pair("fps", avatar.fps.has_value())})
            if (is_used)
                document.refuse(below(key_path, key), std::string("only ") + kCaches + " has it; remove it");
        return;
    }
    const std::filesystem::path& file = *file_of(avatar);
    const bool has_faces = exports::features_of(exports::cache_format(file)).faces;
    if (!has_faces && !avatar.mesh)
        document.refuse(key_path, "the key \"mesh\" is missing; " + as_written(file.string()) +
                                      " has no faces, name the OBJ on which it plays");
    if (has_faces && avatar.mesh)
        document.refuse(below(key_path, "mesh"),
                        as_written(file.string()) + " has faces of its own; remove it");
    if (avatar.mesh)
        check_shape_file(document, below(key_path, "mesh"), *avatar.mesh);
    if (avatar.fps && has_times(file))
        document.refuse(below(key_path, "fps"),
                        as_written(file.string()) + " has times of its own; remove it, or write speed");
    if (avatar.accumulate_root)
        document.refuse(below(key_path, "accumulate_root"), "a cache has no root; remove it");
}

/// Checks keys that only an animated avatar supports.
void check_avatar_motion(const Document& document, const std::string& key_path, const Avatar& avatar)
{
    const bool from_file = file_of(avatar) != nullptr;
    const bool is_skinned = from_file || std::holds_alternative<Mannequin>(avatar.shape);
    const Preroll& preroll = avatar.preroll;
    const std::pair<const char*, bool> used[] = {
        {"clip", !avatar.clip.empty()},
        {"motion", avatar.motion.has_value()},
        {"loop", avatar.loop},
        {"accumulate_root", avatar.accumulate_root},
        {"speed", avatar.speed != 1.0},
        {"start", avatar.start != 0.0},
        {"preroll", preroll.hold != 0.0 || preroll.ease != 0.0 || preroll.from_bind}};
    for (const auto& [key, is_used] : used) {
        if (is_used && !is_skinned)
            document.refuse(below(key_path, key), "a shape has no clips; move it with keyframes");
        if (is_used && avatar.clip.empty() && !avatar.motion && !plays_cache(avatar))
            document.refuse(below(key_path, key), "has no effect without a clip; name the clip to play");
    }
    if (avatar.motion)
        check_motion_file(document, below(key_path, "motion"), avatar);
    if (!avatar.keyframes.empty() && !plays_cache(avatar) &&
        (!avatar.clip.empty() || avatar.motion || (is_skinned && !from_file)))
        document.refuse(below(key_path, "keyframes"),
                        "an animated avatar is not moved by keyframes; remove them " +
                            std::string("or the clip"));
    if (!avatar.exclude_bones.empty() && !is_skinned)
        document.refuse(below(key_path, "exclude_bones"), "a shape has no bones");
    if (avatar.unit && !from_file)
        document.refuse(below(key_path, "unit"), "only a file has a unit; lengths here are in metres");
    if (avatar.up && !from_file)
        document.refuse(below(key_path, "up"), "only a file has an upward axis; it is Y here");
    check_cache(document, key_path, avatar);
}

void check_avatars(const Document& document, const scenes::Scene& scene)
{
    check_names(document, "avatars", names_of(scene.avatars));
    for (size_t i = 0; i < scene.avatars.size(); ++i) {
        const Avatar& avatar = scene.avatars[i];
        const std::string key_path = below("avatars", i);
        if (avatar.name == kFixed)
            document.refuse(below(key_path, "name"),
                            "\"fixed\" stands for the world in attachments; choose " +
                                std::string("another name"));
        if (const std::filesystem::path* file = file_of(avatar))
            check_extension_or_cache(document, below(key_path, "file"), *file,
                                     {".glb", ".gltf", ".fbx", ".obj"});
        check_avatar_motion(document, key_path, avatar);
        check_keyframes(document, key_path, avatar.keyframes);
    }
}

// --- cloths ---

/// Vertices of a generated shape, to a few per cent: area over that of two equilateral triangles.
double vertices_of(const ClothShape& shape)
{
    const auto count = [](double area, double resolution) {
        return area / (0.866 * resolution * resolution);
    };
    if (const auto* r = std::get_if<Rectangle>(&shape))
        return count(r->size.prod(), r->resolution);
    if (const auto* d = std::get_if<Disc>(&shape))
        return count(std::numbers::pi * d->radius * d->radius, d->resolution);
    if (const auto* s = std::get_if<Skirt>(&shape))
        return count(std::numbers::pi * s->length * (s->waist_radius + s->hem_radius), s->resolution);
    return 0.0;
}

void check_skirt(const Document& document, const std::string& key_path, const Skirt& skirt)
{
    const double widest = skirt.waist_radius + skirt.length;
    if (skirt.hem_radius < skirt.waist_radius || skirt.hem_radius > widest)
        document.refuse(below(key_path, "hem_radius"),
                        as_written(skirt.hem_radius) + " m does not fit the cloth; give a radius from " +
                            as_written(skirt.waist_radius) + " (waist_radius) to " + as_written(widest) +
                            " (waist_radius + length)");
}

/// Checks keys that depend on others.
void check_rest(const Document& document, const std::string& key_path, const Cloth& cloth)
{
    const bool is_from_uv = cloth.rest == RestFrom::Uv;
    if (is_from_uv && !std::holds_alternative<std::filesystem::path>(cloth.shape))
        document.refuse(below(key_path, "rest"),
                        "only a file has texture coordinates; remove it, or write \"shape\"");
    if (cloth.rest_file && !is_from_uv)
        document.refuse(below(key_path, "rest_file"),
                        "has no effect on a rest shape that is the mesh; add \"rest\": \"uv\" or remove it");
    if (cloth.rest_file)
        check_shape_file(document, below(key_path, "rest_file"), *cloth.rest_file);
    if (cloth.uv_scale && !is_from_uv)
        document.refuse(below(key_path, "uv_scale"),
                        "has no effect on a rest shape that is the mesh; add \"rest\": \"uv\" or remove it");
}

void check_folds(const Document& document, const std::string& key_path, const Cloth& cloth,
                 SolverMethod method)
{
    for (size_t i = 0; i < cloth.folds.size(); ++i)
        if (const size_t count = cloth.folds[i].vertices.size(); count < 2)
            document.refuse(below(below(below(key_path, "folds"), i), "vertices"),
                            std::to_string(count) + (count == 1 ? " vertex" : " vertices") +
                                "; a fold needs two or more");
    if (!cloth.folds.empty() && cloth.subdivide > 0)
        document.refuse(below(key_path, "subdivide"),
                        "splits the edges that folds run along; remove it, or the folds");
    if (!cloth.folds.empty() && replaces_minimiser(method))
        document.refuse(below(key_path, "folds"), as_written(word_of(method)) +
                                                      " has no folds; choose another solver.method, or " +
                                                      "remove them");
}

void check_print(const Document& document, const std::string& key_path, const Cloth& cloth)
{
    if (cloth.pattern && cloth.print != Print::Plain && cloth.print != *cloth.pattern)
        document.refuse(below(key_path, "pattern"),
                        "is the former name of print, which is given too; remove it");
}

void check_pressure(const Document& document, const std::string& key_path, const Cloth& cloth,
                    SolverMethod method)
{
    if (cloth.pressure && replaces_minimiser(method))
        document.refuse(key_path, "is unknown to solver.method " + as_written(word_of(method)) +
                                      "; choose another method, or remove it");
}

void check_painted(const Document& document, const std::string& key_path, const Cloth& cloth,
                   SolverMethod method)
{
    if (!cloth.painted)
        return;
    if (!cloth.painted->stiffness && !cloth.painted->thickness)
        document.refuse(key_path, "paints nothing; add stiffness or thickness, or remove it");
    if (!std::holds_alternative<std::filesystem::path>(cloth.shape))
        document.refuse(key_path, "only a file has colours; remove it, or give the cloth as a file");
    if (cloth.painted->thickness && cloth.thickness)
        document.refuse(below(key_path, "thickness"), "is given beside the cloth's thickness; remove one");
    if (replaces_minimiser(method))
        document.refuse(key_path, "is unknown to solver.method " + as_written(word_of(method)) +
                                      "; choose another method, or remove it");
}

void check_elastics(const Document& document, const std::string& key_path, const Cloth& cloth,
                    SolverMethod method)
{
    if (cloth.elastics.empty())
        return;
    if (cloth.subdivide > 0)
        document.refuse(key_path, "run along edges of the file, which subdivide splits; remove one of them");
    if (replaces_minimiser(method))
        document.refuse(key_path, "are unknown to solver.method " + as_written(word_of(method)) +
                                      "; choose another method, or remove them");
    for (size_t i = 0; i < cloth.elastics.size(); ++i)
        if (cloth.elastics[i].vertices.size() < 2)
            document.refuse(below(below(key_path, i), "vertices"),
                            "an elastic runs along edges; name two vertices at least");
}

void check_tacks(const Document& document, const std::string& key_path, const Cloth& cloth,
                 SolverMethod method)
{
    if (!cloth.tacks.empty() && replaces_minimiser(method))
        document.refuse(key_path, "are unknown to solver.method " + as_written(word_of(method)) +
                                      "; choose another method, or remove them");
}

void check_groups(const Document& document, const std::string& key_path, const Cloth& cloth,
                  SolverMethod method)
{
    if (cloth.groups.empty())
        return;
    if (!std::holds_alternative<std::filesystem::path>(cloth.shape))
        document.refuse(key_path, "only a file has groups; remove them, or give the cloth as a file");
    if (replaces_minimiser(method))
        document.refuse(key_path, "solver.method " + as_written(word_of(method)) +
                                      " takes one fabric; choose another method, or remove them");
}

void check_cloths(const Document& document, const scenes::Scene& scene)
{
    if (scene.cloths.empty() && scene.solids.empty() && scene.soft_bodies.empty())
        document.refuse("cloths", "nothing to simulate; add a cloth, a solid or a soft body");
    check_names(document, "cloths", names_of(scene.cloths));
    for (size_t i = 0; i < scene.cloths.size(); ++i) {
        const Cloth& cloth = scene.cloths[i];
        const std::string key_path = below("cloths", i);
        if (const auto* file = std::get_if<std::filesystem::path>(&cloth.shape))
            check_shape_file(document, below(key_path, "file"), *file);
        else if (cloth.unit.value_or(LengthUnit::Metre) != LengthUnit::Metre)
            document.refuse(below(key_path, "unit"), "only a file has a unit; lengths here are in metres");
        if (const auto* skirt = std::get_if<Skirt>(&cloth.shape))
            check_skirt(document, below(key_path, "skirt"), *skirt);
        check_rest(document, key_path, cloth);
        check_folds(document, key_path, cloth, scene.solver.method);
        check_print(document, key_path, cloth);
        check_groups(document, below(key_path, "groups"), cloth, scene.solver.method);
        check_pressure(document, below(key_path, "pressure"), cloth, scene.solver.method);
        check_painted(document, below(key_path, "painted"), cloth, scene.solver.method);
        check_elastics(document, below(key_path, "elastics"), cloth, scene.solver.method);
        check_tacks(document, below(key_path, "tacks"), cloth, scene.solver.method);
        if (vertices_of(cloth.shape) * std::pow(4.0, cloth.subdivide) > kMaxVertices)
            document.refuse(key_path,
                            "resolution and subdivide make more than 5 million vertices; choose a " +
                                std::string("coarser resolution"));
    }
}

// --- fabrics ---

/// Checks that every base is a preset, every cloth's fabric exists, and the numbers make a possible material.
void check_fabrics(const Document& document, const scenes::Scene& scene)
{
    std::vector<std::string> presets;
    for (const garment::Fabric& fabric : garment::fabric_presets())
        presets.push_back(fabric.name);
    for (const auto& [name, fabric] : scene.fabrics)
        require_known(document, below(below("fabrics", name), "base"), "preset", fabric.base, presets);

    std::vector<std::string> known;
    for (const auto& [name, fabric] : scene.fabrics)
        known.push_back(name);
    known.insert(known.end(), presets.begin(), presets.end());
    for (size_t i = 0; i < scene.cloths.size(); ++i) {
        require_known(document, below(below("cloths", i), "fabric"), "fabric", scene.cloths[i].fabric, known);
        static_cast<void>(scenes::fabric_of(scene, scene.cloths[i]));
        for (const auto& [name, group] : scene.cloths[i].groups) {
            require_known(document, below(below(below(below("cloths", i), "groups"), name), "fabric"),
                          "fabric", group.fabric, known);
            static_cast<void>(scenes::fabric_of(scene, group));
        }
    }
}

// --- attachments ---

void check_selection(const Document& document, const std::string& key_path, const Selection& select,
                     const std::vector<std::string>& avatars)
{
    if (const auto* box = std::get_if<SelectBox>(&select.by);
        box != nullptr && (box->lower.array() > box->upper.array()).any())
        document.refuse(below(key_path, "box"), "a coordinate of lower exceeds that of upper; exchange them");
    if (const auto* near = std::get_if<SelectNearAvatar>(&select.by))
        require_known(document, below(below(key_path, "all_within"), "avatar"), "avatar", near->avatar,
                      avatars);
    const auto* vertices = std::get_if<std::vector<int>>(&select.by);
    const auto* points = std::get_if<std::vector<Vec3>>(&select.by);
    if ((vertices != nullptr && vertices->empty()) || (points != nullptr && points->empty()))
        document.refuse(below(key_path, vertices != nullptr ? "vertices" : "nearest"),
                        "the list is empty; name at least one or remove the attachment");
}

void check_attachments(const Document& document, const scenes::Scene& scene)
{
    std::vector<std::string> attached = names_of(scene.cloths);
    for (const SoftBody& body : scene.soft_bodies)
        attached.push_back(body.name);
    const char* const kind = scene.soft_bodies.empty() ? "cloth" : "cloth or soft body";
    const std::vector<std::string> avatars = names_of(scene.avatars);
    std::vector<std::string> targets = avatars;
    targets.emplace_back(kFixed);
    for (size_t i = 0; i < scene.attachments.size(); ++i) {
        const Attachment& attachment = scene.attachments[i];
        const std::string key_path = below("attachments", i);
        require_known(document, below(key_path, "cloth"), kind, attachment.cloth, attached);
        check_selection(document, below(key_path, "select"), attachment.select, avatars);
        const bool is_filled =
            std::any_of(scene.soft_bodies.begin(), scene.soft_bodies.end(), [&](const SoftBody& body) {
                return body.name == attachment.cloth && body.cell.has_value();
            });
        if (is_filled && std::holds_alternative<std::vector<int>>(attachment.select.by))
            document.refuse(below(below(key_path, "select"), "vertices"),
                            "the tetrahedra that fill " + as_written(attachment.cloth) +
                                " have no numbers; use box, nearest or all_within");
        require_known(document, below(key_path, "to"), "avatar", attachment.to, targets);
        if (!attachment.keyframes.empty() && attachment.to != kFixed)
            document.refuse(below(key_path, "keyframes"),
                            "an avatar moves these vertices already; remove the " +
                                std::string("keyframes or write \"to\": \"fixed\""));
        check_keyframes(document, key_path, attachment.keyframes);
        if (attachment.pivot && attachment.keyframes.empty())
            document.refuse(below(key_path, "pivot"),
                            "nothing turns without keyframes; add some or remove it");
        if (attachment.exact && attachment.stiffness)
            document.refuse(below(key_path, "exact"),
                            "an exact attachment has no stiffness; remove one of the two keys");
    }
}

// --- contact ---

void check_contact(const Document& document, const scenes::Scene& scene)
{
    const std::vector<std::string> avatars = names_of(scene.avatars), solids = names_of(scene.solids);
    std::vector<std::string> known = avatars;
    known.insert(known.end(), solids.begin(), solids.end());
    for (const SoftBody& body : scene.soft_bodies)
        known.push_back(body.name);
    for (const Cloth& cloth : scene.cloths)
        if (!contains(known, cloth.fabric))
            known.push_back(cloth.fabric);
    const std::vector<FrictionPair>& pairs = scene.contact.friction_pairs;
    for (size_t i = 0; i < pairs.size(); ++i) {
        const std::string key_path = below(below(below("contact", "friction_pairs"), i), "between");
        if (pairs[i].between.size() != 2)
            document.refuse(key_path, std::to_string(pairs[i].between.size()) + " names; give exactly two");
        for (const std::string& name : pairs[i].between) {
            require_known(document, key_path, "fabric in use, avatar, solid or soft body", name, known);
            if (const SoftBody* body = scenes::replacement_of(scene, name))
                document.refuse(key_path, as_written(name) + " is replaced in contact by soft body " +
                                              as_written(body->name) + "; name that");
        }
        if (contains(avatars, pairs[i].between[0]) && contains(avatars, pairs[i].between[1]))
            document.refuse(key_path, "avatars have no friction with each other; name a fabric or solid");
    }
}

} // namespace

void require_consistent(const Document& document, const scenes::Scene& scene)
{
    check_avatars(document, scene);
    check_cloths(document, scene);
    check_solids(document, scene);
    check_soft_bodies(document, scene);
    check_fabrics(document, scene);
    check_attachments(document, scene);
    check_contact(document, scene);
    check_exports(document, scene);
}

} // namespace toile::scene_format
