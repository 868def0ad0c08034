#include <cmath>
#include <iostream>
#include <memory>

#include <nlohmann/json.hpp>

#include "apps/toile/cache_cloth.h"
#include "apps/toile/command_line.h"
#include "apps/toile/commands.h"
#include "apps/toile/penetration.h"
#include "apps/toile/progress.h"
#include "apps/toile/strain.h"
#include "core/backend/atomic_file.h"
#include "core/backend/error.h"
#include "scenes/format/read_scene.h"

namespace toile {

namespace {

using Json = nlohmann::ordered_json;

struct CheckOptions {
    std::filesystem::path cache;
    std::filesystem::path scene;
    std::filesystem::path output; ///< empty: standard output
    std::string cloth;
    double penetration_limit = 0.001; ///< [m]
    double strain_margin = 0.05;      ///< [-] allowed beyond the fabric's strain limit
    bool quiet = false;
};

/// What was found in one frame.
struct FrameFindings {
    int non_finite = 0;       ///< vertices
    double penetration = 0.0; ///< [m]
    double excluded = 0.0;    ///< [m] depth where an avatar intersects itself
    double strain = 0.0;      ///< [-]
};

/// What holds of a whole cache.
struct Certificate {
    int frames = 0;
    int non_finite = 0;
    FrameFindings worst;
    int worst_penetration_frame = 0;
    int worst_strain_frame = 0;
    int first_bad_frame = -1;

    void add(int frame, const FrameFindings& found, double penetration_limit, double strain_limit)
    {
        ++frames;
        non_finite += found.non_finite;
        if (found.penetration > worst.penetration) {
            worst.penetration = found.penetration;
            worst_penetration_frame = frame;
        }
        if (found.strain > worst.strain) {
            worst.strain = found.strain;
            worst_strain_frame = frame;
        }
        worst.excluded = std::max(worst.excluded, found.excluded);
        const bool good =
            found.non_finite == 0 && found.penetration <= penetration_limit && found.strain <= strain_limit;
        if (!good && first_bad_frame < 0)
            first_bad_frame = frame;
    }

    bool holds() const { return first_bad_frame < 0; }
};

FrameFindings examine(View<const Vec3> x, const StrainMeter& strain, const ScenePenetration& penetration)
{
    FrameFindings found;
    for (const Vec3& p : x)
        found.non_finite += p.allFinite() ? 0 : 1;
    const ScenePenetration::Depth depth = penetration.measure(x);
    found.penetration = depth.deepest;
    found.excluded = depth.excluded;
    if (found.non_finite == 0)
        found.strain = strain.largest(x);
    return found;
}

Certificate examine_all(const PointCache& cache, const Scene& scene, const ClothState& cloth,
                        const CheckOptions& options, double strain_limit)
{
    const StrainMeter strain(cloth.rest.positions, cloth.triangles);
    ScenePenetration penetration(scene, cloth.triangles, int(cloth.positions.size()));
    Progress progress("check", cache.frame_count(), options.quiet);
    Certificate certificate;
    for (int frame = 0; frame < cache.frame_count(); ++frame) {
        penetration.advance_to(frame * scene.frame_duration());
        certificate.add(frame, examine(cache.frame(frame), strain, penetration), options.penetration_limit,
                        strain_limit);
        progress.update(frame + 1);
    }
    return certificate;
}

Json json_of(const Certificate& certificate, const CheckOptions& options, const ClothState& cloth,
             double strain_limit)
{
    return {{"cache", options.cache.string()},
            {"scene", options.scene.string()},
            {"cloth", cloth.name},
            {"holds", certificate.holds()},
            {"frames", certificate.frames},
            {"max_penetration_m", certificate.worst.penetration},
            {"max_penetration_frame", certificate.worst_penetration_frame},
            {"max_penetration_in_self_intersections_m", certificate.worst.excluded},
            {"max_strain", certificate.worst.strain},
            {"max_strain_frame", certificate.worst_strain_frame},
            {"non_finite", certificate.non_finite},
            {"first_bad_frame", certificate.holds() ? Json(nullptr) : Json(certificate.first_bad_frame)},
            {"limits", {{"penetration_m", options.penetration_limit}, {"strain", strain_limit}}}};
}

int check(const CheckOptions& options)
{
    if (!(options.penetration_limit >= 0.0) || !(options.strain_margin >= 0.0))
        throw InvalidInput("--penetration and --strain-margin must be 0 or more");
    const Scene scene = read_scene(options.scene);
    const PointCache cache = read_cache(options.cache);
    const int index = cloth_of_cache(scene, options.cache, options.cloth);
    const World world(scene);
    const ClothState& cloth = world.cloths()[index];
    require_same_points(cache, options.cache, cloth.name, int(cloth.positions.size()));

    const double strain_limit = cloth.fabric.strain_limit + options.strain_margin;
    const Certificate certificate = examine_all(cache, scene, cloth, options, strain_limit);
    const std::string text = json_of(certificate, options, cloth, strain_limit).dump(2) + "\n";
    if (options.output.empty())
        std::cout << text;
    else
        write_atomically(options.output, text);
    return certificate.holds() ? kExitOk : kExitFailure;
}

} // namespace

Command add_check(CLI::App& program)
{
    Command command;
    command.options = program.add_subcommand("check", "Certify a cache: penetration, strain, finite numbers");
    auto options = std::make_shared<CheckOptions>();
    CLI::App& add = *command.options;
    add.add_option("cache", options->cache, "Cache (.pc2, .mdd, .obj)")->required();
    add.add_option("--scene", options->scene, "Scene that it was made from")->required();
    add.add_option("-o,--output", options->output, "Write the JSON here instead of to stdout");
    add.add_option("--cloth", options->cloth, "Cloth of the scene [told by the cache's name]");
    add.add_option("--penetration", options->penetration_limit, "Depth inside an avatar that is let pass [m]")
        ->capture_default_str();
    add.add_option("--strain-margin", options->strain_margin,
                   "Strain that is let pass beyond the fabric's limit")
        ->capture_default_str();
    add.add_flag("--quiet", options->quiet, "No progress on stderr");
    command.run = [options] { return check(*options); };
    return command;
}

} // namespace toile
