#include "research/benchmarks/stress/cases.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "collision/body/collider_pairs.h"
#include "collision/contact/contact.h"
#include "core/mesh/obj.h"
#include "research/benchmarks/stress/sliver_sheet.h"
#include "scenes/format/scene_fabric.h"
#include "scenes/meshes/shape_mesh.h"

namespace toile::research::stress {

namespace {

/// Name of the fabric that cases vary.
const char* const kFabric = "stress";

/// Shear modulus over stretch modulus, typical of woven cloth [-].
constexpr double kShearFraction = 0.4;

/// Decay rate [1/s] of velocities in every case. With a fabric's default of 0.1 hems swing for a minute, and
/// without friction nothing else stops cloth.
constexpr double kDamping = 2.0;

/// Longest edge of a sliver over its height [-].
constexpr double kSliverAspect = 1e4;

/// Time of the ball's jump [s]: cloth has landed before.
constexpr double kJumpTime = 1.5;

constexpr double kSide = 0.4;       ///< [m] of every sheet
constexpr double kBallRadius = 0.1; ///< [m]

/// Parameters of most cases, with default values.
struct Drape {
    double dt = 1.0 / 120.0;     ///< [s]
    double stiffness = 261.0;    ///< [N/m] stretch; shear follows
    double areal_density = 0.15; ///< [kg/m^2]
    double friction = 0.3;       ///< [-]
};

std::string number(double value)
{
    char text[32];
    std::snprintf(text, sizeof text, "%g", value);
    return text;
}

scene::Avatar floor_plane()
{
    scene::Avatar floor;
    floor.name = "floor";
    floor.shape = scene::Plane{};
    return floor;
}

scene::Avatar ball()
{
    scene::Avatar ball;
    ball.name = "ball";
    ball.shape = scene::Sphere{kBallRadius};
    ball.translate = Vec3(0.0, kBallRadius, 0.0);
    return ball;
}

/// Maximum energy per mass [J/kg] that a ball may add by a jump at `speed` [m/s]. The cloth moves as fast as
/// contact may make it, lies on top of the ball, and is stretched to its limit in both directions.
double energy_of_jump(double speed, const scenes::Scene& scene)
{
    const garment::Fabric fabric = scenes::fabric_of(scene, scene.cloths[0]);
    const double fastest = speed <= collision::ColliderPairs::kMaxAdvectionSpeed
                               ? speed
                               : collision::Contact::Settings{}.recovery_speed;
    const double stretch = fabric.stretch_warp * fabric.strain_limit * fabric.strain_limit;
    return 0.5 * fastest * fastest + scene.gravity.norm() * 2.0 * kBallRadius +
           stretch / fabric.areal_density;
}

/// Makes the cases of one size.
class CaseMaker {
public:
    CaseMaker(Size size, std::filesystem::path folder)
        : quick_(size == Size::Quick), folder_(std::move(folder))
    {
    }

    std::vector<Case> make()
    {
        vary_one();
        corners();
        meshes();
        random_starts();
        jumps();
        at_rest();
        return std::move(cases_);
    }

private:
    /// A sheet above a ball on the floor, a little off centre, for some seconds.
    Case drape(const std::string& name, const Drape& parameters) const
    {
        Case result;
        result.name = name;
        scenes::Scene& scene = result.scene;
        scene.source = name;
        scene.fps = 1.0 / parameters.dt;
        scene.frames = 1 + int(std::lround((quick_ ? 5.0 : 10.0) / parameters.dt));
        scene.solver.substeps = 1;
        scene.solver.sleep.enabled = false;

        scene.contact.friction = parameters.friction;
        scene.avatars = {floor_plane(), ball()};

        scene::Fabric& fabric = scene.fabrics[kFabric];
        fabric.areal_density = parameters.areal_density;
        fabric.stretch = {parameters.stiffness, parameters.stiffness};
        fabric.shear = kShearFraction * parameters.stiffness;
        fabric.damping = kDamping;

        scene::Cloth cloth;
        cloth.name = "sheet";
        cloth.fabric = kFabric;
        cloth.shape = scene::Rectangle{Vec2(kSide, kSide), quick_ ? 0.08 : 0.04};
        cloth.translate = Vec3(0.02, 0.3, 0.01);
        scene.cloths = {cloth};
        return result;
    }

    void add(const std::string& name, const Drape& parameters) { cases_.push_back(drape(name, parameters)); }

    void vary_one()
    {
        for (const int rate : {1000, 300, 60, 30, 10})
            add("dt 1/" + std::to_string(rate), {.dt = 1.0 / rate});
        for (const double stiffness : {1.0, 1e2, 1e4, 1e7})
            add("stiffness " + number(stiffness), {.stiffness = stiffness});
        for (const double density : {0.01, 0.1, 1.0})
            add("density " + number(density), {.areal_density = density});
        for (const double friction : {0.0, 0.3, 1.0, 10.0})
            add("friction " + number(friction), {.friction = friction});
    }

    /// Combinations of extremes.
    void corners()
    {
        for (const int rate : {1000, 10})
            for (const double stiffness : {1.0, 1e7})
                for (const double density : {0.01, 1.0})
                    add("dt 1/" + std::to_string(rate) + " stiffness " + number(stiffness) + " density " +
                            number(density),
                        {.dt = 1.0 / rate, .stiffness = stiffness, .areal_density = density});
    }

    void meshes()
    {
        for (const auto& [kind, name] :
             {std::pair(Sliver::Needle, "needles"), std::pair(Sliver::Cap, "caps")}) {
            Case slivers = drape(std::string(name) + " of aspect " + number(kSliverAspect), {});
            const std::filesystem::path file = folder_ / (std::string(name) + ".obj");
            write_obj(file, sliver_sheet(kind, kSide, quick_ ? 4 : 8, kSliverAspect));
            slivers.scene.cloths[0].shape = file;
            cases_.push_back(std::move(slivers));
        }
    }

    void random_starts()
    {
        for (const double stiffness : {1.0, 261.0, 1e7}) {
            Case chaos = drape("random start stiffness " + number(stiffness), {.stiffness = stiffness});
            chaos.start = RandomStart{Vec3(-0.2, 0.05, -0.2), Vec3(0.2, 0.45, 0.2), 7};
            cases_.push_back(std::move(chaos));
        }
    }

    /// Cases in which the ball jumps a metre within one step: away from under the cloth, and into cloth on
    /// the floor.
    void jumps()
    {
        const std::filesystem::path file = folder_ / "ball.obj";
        write_obj(file, scenes::shape_mesh(collision::SphereShape{kBallRadius}, 0.0));
        for (const double dt : {1.0 / 120.0, 0.1}) {
            cases_.push_back(jump("away", Vec3::Zero(), Vec3(1.0, 0.0, 0.0), dt));
            cases_.push_back(jump("in", Vec3(-1.0, -kBallRadius, 0.0), Vec3(1.0, 0.0, 0.0), dt));
            cases_.push_back(jump("in (mesh)", Vec3(-1.0, -kBallRadius, 0.0), Vec3(1.0, 0.0, 0.0), dt));
            cases_.back().scene.avatars[1].shape = file;
        }
    }

    Case jump(const std::string& where, const Vec3& from, const Vec3& by, double dt) const
    {
        Case result = drape("ball jumps " + where + " dt 1/" + number(std::round(1.0 / dt)), {.dt = dt});
        const double time = dt * std::round(kJumpTime / dt);
        scene::Avatar& ball = result.scene.avatars[1];
        ball.translate += from;
        ball.keyframes = {{time, Vec3::Zero(), Vec3::Zero()}, {time + dt, by, Vec3::Zero()}};
        result.granted_energy = energy_of_jump(by.norm() / dt, result.scene);
        return result;
    }

    /// Cases in which settled cloth must stay where it is.
    void at_rest()
    {
        for (const char* where : {"hanging", "on the floor", "on the ball"}) {
            Case rest = drape(std::string("at rest ") + where, {});
            rest.starts_at_rest = true;
            scenes::Scene& scene = rest.scene;
            scene.settle = 20.0;
            scene.frames = 1 + (quick_ ? 2000 : 100000);
            scene.cloths[0].shape = scene::Rectangle{Vec2(kSide, kSide), 0.1};
            if (where != std::string("on the ball"))
                scene.avatars.pop_back();
            if (where == std::string("hanging")) {
                scene.cloths[0].translate.y() = 0.6;
                scene.solver.integrator = Integrator::ImplicitEuler; // a swing of second order does not rest
                scene::Attachment pins;
                pins.cloth = scene.cloths[0].name;
                pins.select.by = std::vector<int>{0, 4};
                scene.attachments = {pins};
            }
            cases_.push_back(std::move(rest));
        }
    }

    bool quick_;
    std::filesystem::path folder_;
    std::vector<Case> cases_;
};

} // namespace

std::vector<Case> make_cases(Size size, const std::filesystem::path& folder)
{
    return CaseMaker(size, folder).make();
}

} // namespace toile::research::stress
