#include "scenes/format/checks/body_checks.h"

#include <algorithm>

#include <nlohmann/json.hpp>

#include "core/base/extension.h"
#include "scenes/format/field.h"
#include "scenes/format/names.h"
#include "scenes/format/solver_methods.h"

namespace toile::scene_format {

namespace {

using namespace scene;

/// Checks names, which serve caches and friction pairs: none may be that of another object.
void check_body_names(const Document& document, const std::string& list,
                      const std::vector<std::string>& names, const std::vector<std::string>& others,
                      const std::string& kinds)
{
    check_names(document, list, names);
    for (size_t i = 0; i < names.size(); ++i)
        if (contains(others, names[i]))
            document.refuse(below(below(list, i), "name"),
                            as_written(names[i]) + " is the name of a " + kinds + "; choose another name");
}

/// Checks what bodies that are simulated need of the rest of a scene.
void check_contact_of_bodies(const Document& document, const scenes::Scene& scene, const std::string& list)
{
    if (!scene.contact.self)
        document.refuse(below("contact", "self"),
                        "false leaves " + list + " without contact; remove it or the " + list);
    const SolverMethod method = scene.solver.method;
    if (replaces_minimiser(method))
        document.refuse(below("solver", "method"),
                        as_written(word_of(method)) +
                            " moves cloth only; choose another method, or remove the " + list);
}

/// Checks the file of a soft body, or that an avatar's surface is filled instead.
void check_source(const Document& document, const std::string& key_path, const SoftBody& body)
{
    if (!body.file && !body.core)
        document.refuse(key_path, "has no file; name one, or a core with an avatar whose surface is filled");
    const std::string source = body.file ? as_written(body.file->string()) : "the avatar of core";
    if (body.file)
        check_extension(document, below(key_path, "file"), *body.file, {".msh", ".vtk", ".obj"});
    const bool is_surface = !body.file || lower_case_extension(*body.file) == ".obj";
    if (is_surface && !body.cell)
        document.refuse(key_path, source + " is a surface; say how fine it is filled with tetrahedra: "
                                           "\"cell\": 0.02 has edges of 2 cm");
    if (!is_surface && body.cell)
        document.refuse(below(key_path, "cell"),
                        "only a surface (.obj) is filled with tetrahedra; " + source + " has them");
    const std::pair<const char*, bool> placed[] = {{"unit", body.unit != LengthUnit::Metre},
                                                   {"scale", body.scale != 1.0},
                                                   {"translate", !body.translate.isZero(0.0)},
                                                   {"rotate_deg", !body.rotate_deg.isZero(0.0)}};
    for (const auto& [key, is_used] : placed)
        if (is_used && !body.file)
            document.refuse(below(key_path, key), "a body without a file is where its avatar is; remove it");
}

/// Checks the surface for pictures and caches, whose name is that of a cache.
void check_render(const Document& document, const std::string& key_path, const SoftBody& body,
                  const scenes::Scene& scene)
{
    check_extension(document, key_path, *body.render, {".obj"});
    for (const auto& names : {names_of(scene.cloths), names_of(scene.avatars), names_of(scene.solids),
                              names_of(scene.soft_bodies)})
        if (contains(names, body.render_name()))
            document.refuse(key_path, "is written as " + as_written(body.render_name()) +
                                          ", but another object has that name; choose another name for it");
}

/// Checks the avatar that a core follows. It is in no contact, so keys about its contact are refused.
void check_core(const Document& document, const std::string& key_path, const SoftBody& body,
                const scenes::Scene& scene)
{
    const std::vector<std::string> avatars = names_of(scene.avatars);
    require_known(document, below(key_path, "avatar"), "avatar", body.core->avatar, avatars);
    const size_t i = size_t(std::find(avatars.begin(), avatars.end(), body.core->avatar) - avatars.begin());
    const Avatar& avatar = scene.avatars[i];
    if (!avatar.has_mesh())
        document.refuse(below(key_path, "avatar"),
                        as_written(avatar.name) + " is a shape; name the mannequin or an avatar from a file");
    const std::pair<const char*, bool> of_contact[] = {
        {"exclude_bones", !avatar.exclude_bones.empty()},
        {"self_contact", avatar.self_contact != SelfContact::Separate},
        {"friction", avatar.friction.has_value()}};
    for (const auto& [key, is_used] : of_contact)
        if (is_used)
            document.refuse(below(below("avatars", i), key),
                            "soft body " + as_written(body.name) + " is in contact instead of " +
                                as_written(avatar.name) + ", which moves its core; remove it");
}

} // namespace

void check_solids(const Document& document, const scenes::Scene& scene)
{
    std::vector<std::string> others = names_of(scene.cloths);
    for (const std::string& avatar : names_of(scene.avatars))
        others.push_back(avatar);
    check_body_names(document, "solids", names_of(scene.solids), others, "cloth or avatar");
    for (size_t i = 0; i < scene.solids.size(); ++i) {
        const Solid& solid = scene.solids[i];
        const std::string key_path = below("solids", i);
        if (const auto* file = std::get_if<std::filesystem::path>(&solid.shape))
            check_extension(document, below(key_path, "file"), *file, {".obj", ".vtk"});
        else if (solid.unit != LengthUnit::Metre)
            document.refuse(below(key_path, "unit"), "only a file has a unit; lengths here are in metres");
    }
    if (!scene.solids.empty())
        check_contact_of_bodies(document, scene, "solids");
}

void check_soft_bodies(const Document& document, const scenes::Scene& scene)
{
    std::vector<std::string> others = names_of(scene.cloths);
    for (const auto& names : {names_of(scene.avatars), names_of(scene.solids)})
        others.insert(others.end(), names.begin(), names.end());
    check_body_names(document, "soft_bodies", names_of(scene.soft_bodies), others, "cloth, avatar or solid");
    for (size_t i = 0; i < scene.soft_bodies.size(); ++i) {
        const SoftBody& body = scene.soft_bodies[i];
        const std::string key_path = below("soft_bodies", i);
        check_source(document, key_path, body);
        if (body.render)
            check_render(document, below(key_path, "render"), body, scene);
        if (body.core)
            check_core(document, below(key_path, "core"), body, scene);
    }
    if (!scene.soft_bodies.empty())
        check_contact_of_bodies(document, scene, "soft bodies");
}

} // namespace toile::scene_format
