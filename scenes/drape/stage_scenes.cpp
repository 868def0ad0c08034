#include "scenes/drape/stage_scenes.h"

#include <algorithm>
#include <numeric>
#include <set>
#include <utility>

#include "garment/fabric/fabric.h"
#include "scenes/drape/notions.h"

namespace toile::scenes {

namespace {

/// Bending rigidity [N m] of cloth that is pressed: hundreds of times that of cotton.
constexpr double kPressedRigidity = 1e-3;
/// Membrane of panels while they are sewn [N/m, -]: at most as stiff as jersey.
constexpr double kSewingStretch = 60.0, kSewingShear = 20.0, kSewingStrainLimit = 1.6;
/// Decay rate of velocities [1/s] of garments that are sewn and pressed. Threads would throw panels, and
/// gathers of great rigidity would turn a skirt over; flaps of centimetres still unfold at once.
constexpr double kViscousDamping = 1000.0;
/// Decay rate of velocities [1/s] of panels that are folded: narrow pleats draw whole panels together.
constexpr double kFoldingDamping = 30.0;
/// Friction of a garment that is pressed: a waistband has to find its waist.
constexpr double kPressingFriction = 0.05;
/// Threads [N/m, N].
constexpr double kThreadStiffness = 2000.0, kThreadForce = 2.0;
constexpr double kVelocityTolerance = 0.05; ///< [m/s]
/// Decay rate of velocities [1/s] of cloth that falls into place, and of cloth that has. A skirt that swings
/// as a pendulum of 0.3 m is damped critically by 11; folds that creep come to rest the sooner the less they
/// are damped.
constexpr double kFallingDamping = 6.0, kHangingDamping = 3.0;

scene::Fabric damped_fabric(const std::string& preset, double damping)
{
    scene::Fabric fabric;
    fabric.base = preset;
    fabric.damping = damping;
    return fabric;
}

scene::Fabric sewing_fabric(const std::string& preset)
{
    const garment::Fabric& own = garment::fabric_preset(preset, "drape");
    scene::Fabric fabric = damped_fabric(preset, kViscousDamping);
    fabric.stretch = {std::min(own.stretch_warp, kSewingStretch), std::min(own.stretch_weft, kSewingStretch)};
    fabric.shear = std::min({own.shear, kSewingShear, 0.5 * own.stretch_warp, 0.5 * own.stretch_weft});
    fabric.strain_limit = std::max(1.0 + own.strain_limit, kSewingStrainLimit);
    return fabric;
}

scene::Fabric pressed_fabric(const std::string& preset)
{
    scene::Fabric fabric = damped_fabric(preset, kViscousDamping);
    fabric.bend = {kPressedRigidity, kPressedRigidity};
    return fabric;
}

scene::Fabric folding_fabric(const std::string& preset) { return damped_fabric(preset, kFoldingDamping); }
scene::Fabric falling_fabric(const std::string& preset) { return damped_fabric(preset, kFallingDamping); }
scene::Fabric hanging_fabric(const std::string& preset) { return damped_fabric(preset, kHangingDamping); }

/// Those that close while the garment is sewn.
std::vector<scene::Tack> immediate(std::vector<scene::Tack> tacks)
{
    std::erase_if(tacks, [](const scene::Tack& tack) { return tack.close_at > 0.0; });
    return tacks;
}

/// Welded vertices that an attachment holds, ascending.
std::vector<int> vertices_of(const garment::BodyAttachment& attachment, const GarmentMesh& mesh)
{
    std::set<int> vertices;
    for (const garment::EdgePart& part : attachment.edges)
        for (const int v : path_along(part, mesh))
            vertices.insert(v);
    for (const garment::PanelPoint& point : attachment.points)
        vertices.insert(mesh.sewn.welded_of[size_t(nearest_vertex(mesh.panels, point))]);
    return {vertices.begin(), vertices.end()};
}

} // namespace

bool stays_attached(const std::string& label)
{
    return label == "lower_interface" || label == "strapless_top";
}

StageScenes::StageScenes(const DrapeSettings& settings, const Garment& garment,
                         const std::vector<WornGarment>& worn, DrapeWatch& watch)
    : settings_(settings), garment_(garment), worn_(worn), watch_(watch)
{
}

Scene StageScenes::fold(const GarmentSurface& panels) const
{
    Scene scene = still_scene_of("fold", panels, folding_fabric);
    scene.gravity.setZero();
    scene.contact.friction = 0.0;
    return scene;
}

Scene StageScenes::sew(const GarmentSurface& panels, std::vector<scene::Tack> tacks) const
{
    Scene scene = still_scene_of("sew", panels, sewing_fabric);
    scene.gravity.setZero();
    scene.contact.friction = 0.0;
    scene.cloths.back().sewing = scene::Sewing{kThreadStiffness, kThreadForce};
    scene.cloths.back().tacks = immediate(std::move(tacks));
    return scene;
}

Scene StageScenes::press(const GarmentMesh& mesh, View<const Vec3> x) const
{
    Scene scene = still_scene_of("press", mesh.surface(x), pressed_fabric);
    scene.gravity.setZero();
    scene.contact.friction = kPressingFriction;
    scene.cloths.back().tacks = immediate(tacks_of(garment_.pattern, mesh.panels, mesh.sewn));
    return scene;
}

Scene StageScenes::settle(const GarmentMesh& mesh, View<const Vec3> x) const
{
    Scene scene = still_scene_of("settle", mesh.surface(x), falling_fabric);
    scene.cloths.back().elastics = elastics_of(garment_.pattern, mesh);
    scene.cloths.back().tacks = tacks_of(garment_.pattern, mesh.panels, mesh.sewn);
    hold(garment_, mesh, scene, true);
    return scene;
}

Scene StageScenes::hang(const GarmentMesh& mesh, View<const Vec3> x, bool holds_all, double time) const
{
    Scene scene = scene_of("drape", mesh.surface(x), hanging_fabric);
    for (size_t g = 0; g < worn_.size(); ++g) {
        scene.cloths[g].elastics = elastics_of(worn_[g].garment.pattern, worn_[g].mesh);
        scene.cloths[g].tacks = tacks_of(worn_[g].garment.pattern, worn_[g].mesh.panels, worn_[g].mesh.sewn);
        for (scene::Tack& tack : scene.cloths[g].tacks)
            tack.close_at = 0.0; // it has closed
        hold(worn_[g].garment, worn_[g].mesh, scene, false);
    }
    scene.cloths.back().elastics = elastics_of(garment_.pattern, mesh);
    scene.cloths.back().tacks = tacks_of(garment_.pattern, mesh.panels, mesh.sewn);
    for (scene::Tack& tack : scene.cloths.back().tacks)
        tack.close_at = std::max(0.0, tack.close_at - time);
    hold(garment_, mesh, scene, holds_all);
    return scene;
}

/// The garments below keep the shape that they have.
Scene StageScenes::still_scene_of(const std::string& stage, const GarmentSurface& surface,
                                  FabricInStage* fabric) const
{
    Scene scene = scene_of(stage, surface, fabric);
    for (const WornGarment& worn : worn_) {
        std::vector<int> all(worn.x.size());
        std::iota(all.begin(), all.end(), 0);
        scene::Attachment attachment;
        attachment.cloth = worn.garment.name();
        attachment.select.by = std::move(all);
        scene.attachments.push_back(attachment);
    }
    return scene;
}

Scene StageScenes::scene_of(const std::string& stage, const GarmentSurface& surface,
                            FabricInStage* fabric) const
{
    const std::string name = garment_.name() + "_" + stage;
    Scene scene;
    scene.name = garment_.name() + ", " + stage;
    scene.source = settings_.folder / (name + ".json");
    scene.avatars = {settings_.body};
    std::vector<GarmentSurface> surfaces;
    for (const WornGarment& worn : worn_) {
        surfaces.push_back(worn.surface());
        add_cloth(scene, worn.garment, name + "_over_" + worn.garment.name(), surfaces.back(),
                  hanging_fabric);
    }
    surfaces.push_back(surface);
    add_cloth(scene, garment_, name, surface, fabric);
    watch_.begin(stage, std::move(surfaces), scene.frame_duration());
    scene.solver.quality = scene::Quality::Standard;
    scene.solver.velocity_tolerance = kVelocityTolerance;
    scene.solver.integrator = Integrator::ImplicitEuler;
    scene.solver.sleep.enabled = false; // asleep, it would have neither speed nor strain
    return scene;
}

/// @param file_name  without extension
void StageScenes::add_cloth(Scene& scene, const Garment& garment, const std::string& file_name,
                            const GarmentSurface& surface, FabricInStage* fabric) const
{
    scene::Cloth cloth;
    cloth.name = garment.name();
    const std::filesystem::path file = settings_.folder / (file_name + ".obj");
    write_obj(file, surface.mesh);
    if (!surface.rest.empty()) {
        cloth.rest_file = settings_.folder / (file_name + "_rest.obj");
        write_obj(*cloth.rest_file, surface.rest_mesh());
    }
    cloth.shape = file;
    cloth.weld = false;
    cloth.rest = scene::RestFrom::Uv;
    cloth.uv_scale = 1.0;
    cloth.fabric = file_name;
    cloth.folds = surface.folds;
    cloth.layer = int(scene.cloths.size());
    scene.fabrics[file_name] = fabric(garment.fabric);
    for (const auto& [panel, preset] : garment.panel_fabrics()) {
        std::string name = file_name;
        name += '_';
        name += preset;
        scene.fabrics[name] = fabric(preset);
        cloth.groups[panel].fabric = name;
    }
    scene.cloths.push_back(cloth);
}

/// A vertex of two edges follows the one that stays attached.
void StageScenes::hold(const Garment& garment, const GarmentMesh& mesh, Scene& scene, bool holds_all) const
{
    std::set<int> held;
    const auto attach = [&](std::vector<int> vertices) {
        std::erase_if(vertices, [&](int v) { return !held.insert(v).second; });
        if (vertices.empty())
            return;
        scene::Attachment attachment;
        attachment.cloth = garment.name();
        attachment.select.by = std::move(vertices);
        attachment.to = settings_.body.name;
        scene.attachments.push_back(attachment);
    };
    for (const bool stays : {true, false}) {
        if (!stays && !holds_all)
            break;
        for (const std::string& label : garment.labels())
            if (stays_attached(label) == stays)
                attach(mesh.labelled(garment.pattern, label));
        for (const garment::BodyAttachment& attachment : garment.pattern.attachments)
            if (attachment.is_released != stays)
                attach(vertices_of(attachment, mesh));
    }
}

} // namespace toile::scenes
