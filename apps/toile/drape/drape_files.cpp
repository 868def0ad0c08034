#include "apps/toile/drape/drape_files.h"

#include <algorithm>
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
#include "scenes/format/read_scene.h"
#include "scenes/surfaces/load_cloth.h"

namespace toile::app {

namespace {

using Json = nlohmann::ordered_json;
using std::filesystem::path;

/// Size of the picture [pixels]: upright, as bodies are.
constexpr int kPictureWidth = 720, kPictureHeight = 960;

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
    inputs.emplace_back(file, role);
    if (avatars::is_gltf(file))
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

DrapeFiles::DrapeFiles(const path& garment, path folder)
    : name_(name_of(garment)), folder_(folder.empty() ? path("out") / name_ : std::move(folder))
{
}

void DrapeFiles::require_safe(const garment::Pattern& pattern, const path& avatar,
                              const ClipOptions& clip) const
{
    Inputs inputs;
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
    for (const path& file : {mesh(), rest_mesh(), scene(), report(), certificate(), picture()}) {
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
    for (const path& file : {report(), certificate(), scene(), mesh(), rest_mesh(), picture()})
        std::filesystem::remove(file);
    if (result.surface.mesh.positions.empty())
        return;
    write_obj(mesh(), result.surface.mesh);
    log.file(mesh());
    if (!result.surface.rest.empty()) {
        write_obj(rest_mesh(), result.surface.rest_mesh());
        log.file(rest_mesh());
    }
    if (result.outcome != scenes::DrapeOutcome::Draped)
        return;
    write_atomically(scene(), scene_text(continuation, result));
    log.file(scene());
}

std::string DrapeFiles::scene_text(const Continuation& continuation, const scenes::DrapeResult& result) const
{
    Json json = {{"toile", 1}, {"name", name_ + ", draped"}, {"frames", continuation.frames}};
    json["avatars"] = {json_of(continuation.body)};
    json["cloths"] = {{{"name", name_},
                       {"file", mesh().filename().string()},
                       {"weld", false},
                       {"rest", "uv"},
                       {"uv_scale", 1.0},
                       {"fabric", result.scene.cloths.at(0).fabric}}};
    if (!result.surface.rest.empty())
        json["cloths"][0]["rest_file"] = rest_mesh().filename().string();
    for (const scene::Fold& fold : result.surface.folds)
        json["cloths"][0]["folds"].push_back(
            {{"vertices", fold.vertices}, {"angle_deg", fold.angle_deg}, {"stiffness", fold.stiffness}});
    for (const scene::Attachment& attachment : result.scene.attachments)
        json["attachments"].push_back(
            {{"cloth", name_},
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
    std::optional<Certificate> certified =
        certify(scene_at_rest, {{&surfaces.at(0), mesh(), mesh()}}, {}, log, interrupt);
    if (!certified)
        return std::nullopt;
    write_atomically(certificate(), app::to_json(*certified));
    log.file(certificate());
    return certified;
}

void DrapeFiles::write_report(const DrapeReport& drape, const garment::Pattern& pattern,
                              const RunLog& log) const
{
    write_atomically(report(), to_json(drape, pattern));
    log.file(report());
}

void DrapeFiles::write_picture(const scenes::DrapeSettings& settings, const RunLog& log) const
{
    scenes::Scene shown;
    shown.source = scene();
    shown.avatars = {settings.body};
    shown.render.width = kPictureWidth;
    shown.render.height = kPictureHeight;
    scene::Cloth cloth;
    cloth.name = name_;
    cloth.shape = mesh();
    cloth.weld = false;
    shown.cloths = {cloth};

    Film film = Film::of_caches(shown, {mesh()}, name_);
    film.put_floor_below_avatars();
    film.choose({0});
    preview::write_png(picture(), film.picture(0));
    log.file(picture());
}

} // namespace toile::app
