#include "scenes/drape/stage_scenes.h"

#include <algorithm>

#include "garment/fabric/fabric.h"

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

} // namespace

bool stays_attached(const std::string& label)
{
    return label == "lower_interface" || label == "strapless_top";
}

StageScenes::StageScenes(const DrapeSettings& settings, const garment::Pattern& pattern,
                         const std::string& fabric, DrapeWatch& watch)
    : settings_(settings), pattern_(pattern), fabric_(fabric), watch_(watch)
{
    for (const garment::Panel& panel : pattern.panels)
        for (const garment::PanelEdge& edge : panel.edges)
            if (!edge.label.empty())
                labels_.insert(edge.label);
}

Scene StageScenes::fold(const GarmentSurface& panels) const
{
    Scene scene = scene_of("fold", panels, damped_fabric(kFoldingDamping));
    scene.gravity.setZero();
    scene.contact.friction = 0.0;
    return scene;
}

Scene StageScenes::sew(const GarmentSurface& panels) const
{
    Scene scene = scene_of("sew", panels, sewing_fabric());
    scene.gravity.setZero();
    scene.contact.friction = 0.0;
    scene.cloths[0].sewing = scene::Sewing{kThreadStiffness, kThreadForce};
    return scene;
}

Scene StageScenes::press(const GarmentMesh& mesh, View<const Vec3> x) const
{
    scene::Fabric pressed = damped_fabric(kViscousDamping);
    pressed.bend = {kPressedRigidity, kPressedRigidity};
    Scene scene = scene_of("press", mesh.surface(x), pressed);
    scene.gravity.setZero();
    scene.contact.friction = kPressingFriction;
    return scene;
}

Scene StageScenes::settle(const GarmentMesh& mesh, View<const Vec3> x) const
{
    Scene scene = scene_of("settle", mesh.surface(x), damped_fabric(kFallingDamping));
    hold_labels(mesh, scene, true);
    return scene;
}

Scene StageScenes::hang(const GarmentMesh& mesh, View<const Vec3> x, const std::string& stage,
                        bool holds_all) const
{
    Scene scene = scene_of(stage, mesh.surface(x), damped_fabric(kHangingDamping));
    hold_labels(mesh, scene, holds_all);
    return scene;
}

Scene StageScenes::scene_of(const std::string& stage, const GarmentSurface& surface,
                            const scene::Fabric& fabric) const
{
    Scene scene;
    scene.name = settings_.name + ", " + stage;
    scene.source = settings_.folder / (stage + ".json");
    scene.avatars = {settings_.body};
    scene::Cloth cloth;
    cloth.name = settings_.name;
    const std::filesystem::path file = settings_.folder / (settings_.name + "_" + stage + ".obj");
    write_obj(file, surface.mesh);
    if (!surface.rest.empty()) {
        cloth.rest_file = settings_.folder / (settings_.name + "_" + stage + "_rest.obj");
        write_obj(*cloth.rest_file, surface.rest_mesh());
    }
    watch_.begin(stage, surface, scene.frame_duration());
    cloth.shape = file;
    cloth.weld = false;
    cloth.rest = scene::RestFrom::Uv;
    cloth.uv_scale = 1.0;
    cloth.fabric = stage;
    cloth.folds = surface.folds;
    scene.fabrics[stage] = fabric;
    scene.cloths = {cloth};
    scene.solver.quality = scene::Quality::Standard;
    scene.solver.velocity_tolerance = kVelocityTolerance;
    scene.solver.integrator = Integrator::ImplicitEuler;
    scene.solver.sleep.enabled = false; // asleep, it would have neither speed nor strain
    return scene;
}

scene::Fabric StageScenes::damped_fabric(double damping) const
{
    scene::Fabric fabric;
    fabric.base = fabric_;
    fabric.damping = damping;
    return fabric;
}

scene::Fabric StageScenes::sewing_fabric() const
{
    const garment::Fabric& own = garment::fabric_preset(fabric_, settings_.garment.string());
    scene::Fabric fabric = damped_fabric(kViscousDamping);
    fabric.stretch = {std::min(own.stretch_warp, kSewingStretch), std::min(own.stretch_weft, kSewingStretch)};
    fabric.shear = std::min({own.shear, kSewingShear, 0.5 * own.stretch_warp, 0.5 * own.stretch_weft});
    fabric.strain_limit = std::max(1.0 + own.strain_limit, kSewingStrainLimit);
    return fabric;
}

/// A vertex of two edges follows the one that stays attached.
void StageScenes::hold_labels(const GarmentMesh& mesh, Scene& scene, bool holds_all) const
{
    std::set<int> held;
    for (const bool stays : {true, false})
        for (const std::string& label : labels_) {
            if (stays_attached(label) != stays || (!stays && !holds_all))
                continue;
            std::vector<int> vertices = mesh.labelled(pattern_, label);
            std::erase_if(vertices, [&](int v) { return !held.insert(v).second; });
            if (vertices.empty())
                continue;
            scene::Attachment attachment;
            attachment.cloth = settings_.name;
            attachment.select.by = std::move(vertices);
            attachment.to = settings_.body.name;
            scene.attachments.push_back(attachment);
        }
}

} // namespace toile::scenes
