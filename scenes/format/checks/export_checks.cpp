#include "scenes/format/checks/export_checks.h"

#include <algorithm>
#include <set>

#include <nlohmann/json.hpp>

#include "core/base/extension.h"
#include "export/cache_format.h"
#include "scenes/format/field.h"
#include "scenes/format/names.h"

namespace toile::scene_format {

namespace {

using namespace scene;

void check_export_file(const Document& document, const std::string& at_file,
                       const std::filesystem::path& file)
{
    check_extension(document, at_file, file, exports::written_extensions());
    const std::filesystem::path normal = file.lexically_normal();
    if (normal.is_absolute() || *normal.begin() == "..")
        document.refuse(at_file,
                        as_written(file.string()) + " leaves the output folder; give a path inside it");
}

/// True if "all" stands for all surfaces rather than for one of that name.
/// @param known  names of surfaces
bool exports_all(const Export& entry, const std::vector<std::string>& known)
{
    return entry.cloths == std::vector<std::string>{"all"} && !contains(known, "all");
}

/// Checks which surfaces an entry writes, and that its format has room for them.
void check_exported_cloths(const Document& document, const std::string& key_path, const Export& entry,
                           const scenes::Scene& scene)
{
    const std::vector<std::string> known = scenes::surface_names(scene);
    const bool is_of_cloths = known.size() == scene.cloths.size();
    const char* const kind = is_of_cloths ? "cloth" : "surface";
    const bool is_all = exports_all(entry, known);
    std::set<std::string> seen;
    for (const std::string& name : entry.cloths) {
        if (!is_all)
            require_known(document, below(key_path, "cloth"), kind, name, known);
        if (!seen.insert(name).second)
            document.refuse(below(key_path, "cloth"), as_written(name) + " is there twice; name it once");
    }
    if (exports::features_of(exports::cache_format(entry.file)).several)
        return;
    const std::string one_mesh = as_written(lower_case_extension(entry.file)) + " holds one mesh; ";
    if (entry.cloths.size() > 1 || (is_all && known.size() > 1))
        document.refuse(below(key_path, "cloth"),
                        one_mesh + "write one file each, or an .abc or .usda of all");
    if (entry.cloths.empty() && known.size() > 1)
        document.refuse(key_path, "the scene has " + std::to_string(known.size()) +
                                      (is_of_cloths ? " cloths" : " surfaces") +
                                      "; name the one to write with the key \"cloth\"");
    if (entry.avatars)
        document.refuse(below(key_path, "avatars"), one_mesh + "write the avatars to an .abc or .usda");
    if (!entry.weld)
        document.refuse(below(key_path, "weld"), one_mesh + "write the panels to an .abc or .usda");
}

/// Checks what a format can't store. What stays at its default is left out silently.
void check_export_features(const Document& document, const std::string& key_path, const Export& entry,
                           const Solver& solver)
{
    const exports::CacheFormat format = exports::cache_format(entry.file);
    const std::string extension = as_written(lower_case_extension(entry.file));
    if (entry.normals && !exports::features_of(format).normals)
        document.refuse(below(key_path, "normals"), extension + " stores no normals; write an .abc or .usda");
    if (entry.subframes > 1 && exports::features_of(format).numbered)
        document.refuse(below(key_path, "subframes"),
                        extension + " has a file for each frame and none between; write an .abc or .usda");
    if (solver.substeps && *solver.substeps % entry.subframes != 0)
        document.refuse(below(key_path, "subframes"),
                        as_written(entry.subframes) + " does not divide solver.substeps, " +
                            as_written(*solver.substeps) + "; give a divisor of it, or leave substeps out");
}

/// Checks that an avatar has a skin from which the gap is measured. An avatar that a soft body replaces has
/// none.
void check_gap(const Document& document, const std::string& at, const scenes::Scene& scene)
{
    std::string replaced;
    for (const Avatar& avatar : scene.avatars) {
        if (std::holds_alternative<Plane>(avatar.shape))
            continue;
        const SoftBody* body = scenes::replacement_of(scene, avatar.name);
        if (body == nullptr)
            return;
        replaced = as_written(avatar.name) + " is replaced by soft body " + as_written(body->name);
    }
    document.refuse(
        at, "\"gap\" is the distance from avatars, and " +
                (replaced.empty() ? "the scene has none but planes; add one" : replaced + "; add another") +
                ", or leave gap out");
}

/// Checks attributes that need another format, a body, or a cloth.
void check_export_attributes(const Document& document, const std::string& key_path, const Export& entry,
                             const scenes::Scene& scene)
{
    if (entry.attributes.empty())
        return;
    const std::string at = below(key_path, "attributes");
    if (!exports::features_of(exports::cache_format(entry.file)).attributes)
        document.refuse(at, as_written(lower_case_extension(entry.file)) +
                                " stores no attributes; write an .abc, .usda, .usdc, .ply or .pvd");
    for (auto attribute = entry.attributes.begin(); attribute != entry.attributes.end(); ++attribute)
        if (std::find(entry.attributes.begin(), attribute, *attribute) != attribute)
            document.refuse(at, as_written(word_of(*attribute)) + " is there twice; name it once");
    if (entry.stores(ExportAttribute::Gap))
        check_gap(document, at, scene);
    const std::vector<std::string> cloths = names_of(scene.cloths);
    const bool is_all = entry.cloths.empty() || exports_all(entry, scenes::surface_names(scene));
    if (cloths.empty() ||
        (!is_all && std::none_of(entry.cloths.begin(), entry.cloths.end(),
                                 [&](const std::string& name) { return contains(cloths, name); })))
        document.refuse(at, "are of cloths, and the entry writes none; leave them out" +
                                std::string(cloths.empty() ? "" : ", or add a cloth to \"cloth\""));
}

} // namespace

void check_exports(const Document& document, const scenes::Scene& scene)
{
    std::set<std::filesystem::path> seen;
    int subframes = 1;
    for (size_t i = 0; i < scene.exports.size(); ++i) {
        const Export& entry = scene.exports[i];
        const std::string key_path = below("export", i);
        const std::string at_file = below(key_path, "file");
        check_export_file(document, at_file, entry.file);
        if (!seen.insert(entry.file.lexically_normal()).second)
            document.refuse(at_file, as_written(entry.file.string()) +
                                         " is written by an earlier entry; choose another file");
        check_exported_cloths(document, key_path, entry, scene);
        check_export_features(document, key_path, entry, scene.solver);
        check_export_attributes(document, key_path, entry, scene);
        if (entry.subframes > 1 && subframes > 1 && entry.subframes != subframes)
            document.refuse(below(key_path, "subframes"),
                            as_written(entry.subframes) + ", and an earlier entry has " +
                                as_written(subframes) + "; a run has one number besides 1");
        subframes = std::max(subframes, entry.subframes);
    }
}

} // namespace toile::scene_format
