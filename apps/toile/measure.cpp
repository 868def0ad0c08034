#include <cstdio>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "avatars/landmarks/measure_body.h"
#include "scenes/colliders/load_body.h"

namespace toile::app {

namespace {

struct MeasureOptions {
    avatars::AvatarSettings body;
    std::filesystem::path landmarks; ///< empty: all are found
    bool json = false;
};

avatars::UprightBody load_body(const MeasureOptions& options)
{
    const std::unique_ptr<avatars::Avatar> avatar = scenes::load_body(options.body, {});
    TriangleMesh mesh{std::vector<Vec3>(size_t(avatar->vertex_count())), avatar->triangles()};
    avatar->pose({}, avatars::identity_affine(), mesh.positions);
    const avatars::GivenLandmarks given =
        options.landmarks.empty() ? avatars::GivenLandmarks{} : avatars::read_landmarks(options.landmarks);
    return avatars::find_upright_body(std::move(mesh), given, avatar->source());
}

void print_table(const std::vector<avatars::Measurement>& measurements)
{
    for (const avatars::Measurement& m : measurements) {
        char line[64];
        std::snprintf(line, sizeof line, "%-22s%8.2f %-4s", m.key.c_str(),
                      m.is_angle ? m.value : 100.0 * m.value, m.is_angle ? "deg" : "cm");
        std::cout << line << " " << m.meaning << "\n";
    }
    for (const std::string& key : avatars::unmeasured_keys())
        std::cout << key << ": not measured; its points are marked by hand\n";
}

void print_json(const avatars::UprightBody& body, const std::vector<avatars::Measurement>& measurements)
{
    nlohmann::ordered_json json = {{"file", body.source}};
    for (const avatars::Measurement& m : measurements)
        json[m.is_angle ? "angles_deg" : "lengths_m"][m.key] = m.value;
    json["not_measured"] = avatars::unmeasured_keys();
    for (const auto& [name, x] : avatars::by_name(body.landmarks()))
        json["landmarks"][name] = {x.x(), x.y(), x.z()};
    std::cout << json.dump(2, ' ', false, nlohmann::json::error_handler_t::replace) << "\n";
}

int measure(const MeasureOptions& options)
{
    const avatars::UprightBody body = load_body(options);
    const std::vector<avatars::Measurement> measurements = avatars::measure_body(body);
    if (options.json)
        print_json(body, measurements);
    else
        print_table(measurements);
    return kExitOk;
}

} // namespace

Command add_measure(CLI::App& parser)
{
    Command command;
    command.options = parser.add_subcommand("measure", "Measure a body for sewing patterns");
    auto options = std::make_shared<MeasureOptions>();
    CLI::App& add = *command.options;
    add.add_option(
        "body", options->body.file,
        "Body, .obj, .glb, .gltf, .fbx or the first sample of a cache; without it the built-in mannequin");
    add.add_option("--landmarks", options->landmarks, "JSON file of landmarks that replace those found");
    add.add_option("--unit", options->body.unit, "Unit of the file: m, cm, mm or in");
    add.add_option("--up", options->body.up, "Upward axis of the file: y or z");
    add.add_flag("--json", options->json, "Print JSON, in metres and degrees, with the landmarks");
    command.run = [options] { return measure(*options); };
    return command;
}

} // namespace toile::app
