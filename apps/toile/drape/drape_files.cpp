#include "apps/toile/drape/drape_files.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <fstream>

#include <nlohmann/json.hpp>

#include "apps/preview/image.h"
#include "apps/toile/check/certify.h"
#include "apps/toile/render/film.h"
#include "avatars/import/gltf_import.h"
#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/file_plan.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/cache_files.h"
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;
using std::filesystem::path;

/// Size of the picture [pixels]: upright, as bodies are.
constexpr int kPictureWidth = 720, kPictureHeight = 960;

/// Color of a garment, by its number: the first has that of cloth without one.
Vec3 color_of(size_t garment)
{
    static const std::array<Vec3, 4> colors = {scene::Cloth{}.color, Vec3(0.72, 0.34, 0.26),
                                               Vec3(0.42, 0.56, 0.38), Vec3(0.80, 0.66, 0.38)};
    return colors[garment % colors.size()];
}

/// Name of the garment: that of its file, with what can't name a cloth replaced.
std::string name_of(const path& file)
{
    std::string name = file.stem().string();
    if (name.ends_with(".garment"))
        name.resize(name.size() - std::string(".garment").size());
    std::replace_if(
        name.begin(), name.end(),
        [](unsigned char c) { return std::isalnum(c) == 0 && c != '_' && c != '-'; }, '_');
    return name.empty() ? "garment" : name;
}

bool is_within(const path& file, const path& folder)
{
    const path inner = std::filesystem::weakly_canonical(file),
               outer = std::filesystem::weakly_canonical(folder);
    return std::mismatch(outer.begin(), outer.end(), inner.begin(), inner.end()).first == outer.end();
}

using Inputs = std::vector<std::pair<path, std::string>>; ///< files with their roles for messages

/// Adds a file, and the files that it refers to. @param file  may be empty
void add_model(Inputs& inputs, const path& file, const std::string& role)
{
    if (file.empty())
        return;
    for (const path& part : scene_format::files_of(file))
        inputs.emplace_back(part, role);
    if (!scene_format::is_cache(file) && avatars::is_gltf(file))
        for (const path& part : avatars::files_of_gltf(file))
            inputs.emplace_back(part, "a part of " + role);
}

/// The body and its motion as a scene file has them. Paths are absolute.
Json json_of(const scene::Avatar& body)
{
    Json avatar = {{"name", body.name}};
    if (const auto* file = std::get_if<path>(&body.shape))
        avatar["file"] = std::filesystem::absolute(*file).string();
    else
        avatar["mannequin"] = Json::object();
    if (!body.clip.empty())
        avatar["clip"] = body.clip;
    if (body.speed != 1.0)
        avatar["speed"] = body.speed;
    if (body.motion) {
        const scene::AvatarMotion& motion = *body.motion;
        avatar["motion"] = {{"file", std::filesystem::absolute(motion.file).string()}};
        if (!motion.clip.empty())
            avatar["motion"]["clip"] = motion.clip;
        avatar["motion"]["map"] =
            motion.is_mapped_by_file() ? std::filesystem::absolute(motion.map).string() : motion.map;
    }
    if (!body.clip.empty() || body.motion)
        avatar["preroll"] = {{"ease", body.preroll.ease}, {"from_bind", body.preroll.from_bind}};
    return avatar;
}

/// Whether a file is a report of this program, which may be replaced.
bool is_report(const path& file)
{
    std::ifstream stream(file);
    const Json json = Json::parse(stream, nullptr, false);
    return json.is_object() && json.contains("class") && json.contains("message");
}

} // namespace

DrapeFiles::DrapeFiles(const std::vector<path>& garments, path folder)
{
    for (const path& file : garments) {
        const std::string name = name_of(file);
        std::string unique = name;
        for (int copy = 2; std::find(names_.begin(), names_.end(), unique) != names_.end(); ++copy)
            unique = name + "_" + std::to_string(copy);
        names_.push_back(unique);
    }
    folder_ = folder.empty() ? path("out") / name() : std::move(folder);
}

std::string DrapeFiles::name() const
{
    std::string name = names_.front();
    for (size_t g = 1; g < names_.size(); ++g)
        name += "_" + names_[g];
    return name;
}

std::vector<path> DrapeFiles::results() const
{
    std::vector<path> files = fit().all();
    files.insert(files.end(), {report(), certificate(), scene(), picture()});
    for (const std::string& garment : names_) {
        files.push_back(mesh(garment));
        files.push_back(rest_mesh(garment));
    }
    return files;
}

void DrapeFiles::require_safe(const std::vector<garment::Pattern>& patterns, const path& avatar,
                              const ClipOptions& clip) const
{
    Inputs inputs;
    for (const garment::Pattern& pattern : patterns)
        for (const path& file : pattern.files)
            inputs.emplace_back(file, "the pattern");
    add_model(inputs, avatar, "the avatar");
    add_model(inputs, clip.motion, "the motion");
    if (clip.is_mapped_by_file())
        inputs.emplace_back(clip.map, "the map of joints");

    FilePlan plan;
    for (const auto& [file, role] : inputs) {
        if (is_within(file, stages()))
            throw InvalidInput(file.string() + ": " + role + " lies in " + stages().string() +
                               ", whose files are replaced; choose another folder by -o");
        plan.add_input(file, role);
    }
    for (const path& file : results()) {
        plan.add_output(file, "a result of the drape");
        require_writable(file);
    }
    require_writable_folder(stages());
}

exports::FolderLock DrapeFiles::lock(const RunLog& log) const
{
    return exports::FolderLock(folder_, [&](const std::string& text) { log.note("warning: " + text); });
}

void DrapeFiles::write_refusal(const DrapeVerdict& verdict) const
{
    if (std::filesystem::exists(report()) && !is_report(report()))
        return;
    try {
        require_writable(report());
    } catch (const InvalidInput&) {
        return; // the caller tells the refusal of the input, which is what has to be mended first
    }
    write_atomically(report(), to_json(verdict));
}

void DrapeFiles::write_garment(const Continuation& continuation, const scenes::DrapeResult& result,
                               const RunLog& log) const
{
    for (const path& file : results())
        std::filesystem::remove(file);
    for (const scenes::DrapedGarment& garment : result.garments) {
        if (garment.surface.mesh.positions.empty())
            continue;
        write_obj(mesh(garment.name), garment.surface.mesh);
        log.file(mesh(garment.name));
        if (garment.surface.rest.empty())
            continue;
        write_obj(rest_mesh(garment.name), garment.surface.rest_mesh());
        log.file(rest_mesh(garment.name));
    }
    if (result.outcome != scenes::DrapeOutcome::Draped)
        return;
    write_atomically(scene(), scene_text(continuation, result));
    log.file(scene());
}

std::string DrapeFiles::scene_text(const Continuation& continuation, const scenes::DrapeResult& result) const
{
    Json json = {{"toile", 1}, {"name", name() + ", draped"}, {"frames", continuation.frames}};
    json["avatars"] = {json_of(continuation.body)};
    for (size_t g = 0; g < result.garments.size(); ++g) {
        const scenes::DrapedGarment& garment = result.garments[g];
        Json cloth = {{"name", garment.name}, {"file", mesh(garment.name).filename().string()},
                      {"weld", false},        {"rest", "uv"},
                      {"uv_scale", 1.0},      {"fabric", result.scene.cloths.at(g).fabric}};
        if (!garment.surface.rest.empty())
            cloth["rest_file"] = rest_mesh(garment.name).filename().string();
        for (const auto& [panel, group] : result.scene.cloths[g].groups)
            cloth["groups"][panel] = {{"fabric", group.fabric}};
        for (const scene::Elastic& elastic : result.scene.cloths[g].elastics)
            cloth["elastics"].push_back(
                {{"vertices", elastic.vertices}, {"ratio", elastic.ratio}, {"stiffness", elastic.stiffness}});
        for (const scene::Tack& tack : result.scene.cloths[g].tacks)
            cloth["tacks"].push_back({{"a", tack.a}, {"b", tack.b}});
        for (const scene::Fold& fold : garment.surface.folds)
            cloth["folds"].push_back(
                {{"vertices", fold.vertices}, {"angle_deg", fold.angle_deg}, {"stiffness", fold.stiffness}});
        if (g > 0) {
            const Vec3 color = color_of(g);
            cloth["layer"] = g;
            cloth["color"] = {color.x(), color.y(), color.z()};
        }
        json["cloths"].push_back(cloth);
    }
    for (const scene::Attachment& attachment : result.scene.attachments)
        json["attachments"].push_back(
            {{"cloth", attachment.cloth},
             {"select", {{"vertices", std::get<std::vector<int>>(attachment.select.by)}}},
             {"to", attachment.to}});
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::optional<Certificate> DrapeFiles::write_certificate(const RunLog& log,
                                                         const InterruptGuard& interrupt) const
{
    scenes::Scene scene_at_rest = scenes::read_scene(scene());
    scene_at_rest.frames = 1;
    const std::vector<scenes::ClothState> surfaces = scenes::load_surfaces(scene_at_rest);
    std::vector<CachedCloth> checked;
    for (size_t g = 0; g < names_.size(); ++g)
        checked.push_back({&surfaces.at(g), mesh(names_[g]), exports::read_cache(mesh(names_[g]))});
    std::optional<Certificate> certified = certify(scene_at_rest, checked, {}, log, interrupt);
    if (!certified)
        return std::nullopt;
    write_atomically(certificate(), app::to_json(*certified));
    log.file(certificate());
    return certified;
}

void DrapeFiles::write_report(const DrapeReport& drape, const std::vector<garment::Pattern>& patterns,
                              const RunLog& log) const
{
    write_atomically(report(), to_json(drape, patterns));
    log.file(report());
}

void DrapeFiles::write_fit(const scenes::DrapeResult& result, const std::vector<garment::Pattern>& patterns,
                           const scenes::DrapeSettings& settings, const RunLog& log) const
{
    const scenes::SceneBody body(settings.body);
    const auto* file = std::get_if<path>(&settings.body.shape);
    const std::string source = file ? file->string() : settings.body.name;
    std::vector<GarmentFit> fits;
    for (size_t g = 0; g < result.garments.size(); ++g)
        fits.push_back(fit_of(
            fitted_garment(names_[g], result.garments[g].surface, patterns[g], settings.garments[g].fabric),
            body.surface(), source));
    fit().write(fits, body.surface(), log);
}

void DrapeFiles::write_picture(const scenes::DrapeSettings& settings, const RunLog& log) const
{
    scenes::Scene shown;
    shown.source = scene();
    shown.avatars = {settings.body};
    shown.render.width = kPictureWidth;
    shown.render.height = kPictureHeight;
    std::vector<path> meshes;
    for (size_t g = 0; g < names_.size(); ++g) {
        if (!std::filesystem::exists(mesh(names_[g])))
            continue;
        scene::Cloth cloth;
        cloth.name = names_[g];
        cloth.shape = mesh(names_[g]);
        cloth.weld = false;
        cloth.color = color_of(g);
        shown.cloths.push_back(cloth);
        meshes.push_back(mesh(names_[g]));
    }
    if (meshes.empty())
        return;

    Film film = Film::of_caches(shown, meshes, "");
    film.put_floor_below_avatars();
    film.choose({Shot{}});
    preview::write_png(picture(), film.picture(0));
    log.file(picture());
}

} // namespace toile::app
