#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "core/pd/energy/energy.h"
#include "garment/energy/air/aerodynamics.h"
#include "garment/energy/air/gusts.h"
#include "garment/energy/air/pressure.h"
#include "garment/energy/bend_damping.h"
#include "garment/energy/cloth_model.h"
#include "garment/energy/fold/fold_lines.h"
#include "garment/energy/springs.h"
#include "garment/energy/strain_limit/strain_limit.h"
#include "garment/seam/elastics.h"
#include "garment/seam/tacks.h"
#include "scenes/colliders/attachment_constraint.h"
#include "scenes/surfaces/cloth_state.h"
#include "scenes/world/fabric_parts.h"
#include "scenes/world/world_options.h"

namespace toile::garment {
class DeviceLoads;
} // namespace toile::garment

namespace toile::scenes {

/// Aerodynamic settings of a scene's cloth, without gusts.
garment::AirSettings air_of(const Scene& scene);
/// Gusts of a wind; zero without turbulence.
garment::Gusts gusts_of(const scene::Wind& wind);

/// One cloth of a running scene: its fabric as energies, its attachments, the air around it, its strain
/// limit. Its ClothGroup moves it; all arrays here are of the cloth's vertices.
class SceneCloth {
public:
    /// @throws InvalidInput for a mesh, fabric or attachment that does not work.
    SceneCloth(const Scene& scene, const scene::Cloth& settings, const std::vector<Collider>& colliders,
               const WorldOptions& options);

    const ClothState& state() const { return state_; }
    int vertex_count() const { return int(state_.positions.size()); }
    const std::string& source() const { return source_; } ///< name in errors
    const std::shared_ptr<const garment::RestShape>& rest_shape() const { return rest_; }

    const std::vector<double>& masses() const { return masses_; } ///< [vertices] [kg]

    /// Makes the energies of projective dynamics. Call once: the strain limit is connected to the tension
    /// among them.
    std::vector<std::shared_ptr<Energy>> make_energies(OuterMethod outer);

    /// Adds the forces of accelerate() to the loads of a body on a GPU.
    void add_loads(garment::DeviceLoads& loads, int first_vertex) const;

    /// Model of the cloth for a method that replaces the minimiser.
    garment::ClothModel model() const;

    /// [vertices] nonzero for those with an exact attachment to the world, now or later.
    std::vector<char> fixed_in_world() const;

    /// Attaches the attached vertices where they are, and warns of those that are far from their avatar.
    /// @param gap   [m] between avatars and the faces of cloth
    /// @param warn  may be empty
    void tie(double gap, const std::vector<Collider>& colliders,
             const std::function<void(const std::string&)>& warn);

    /// Marks the vertices whose position is prescribed at time t_t1 [s]; clears the others.
    void mark_fixed(double t_t1, View<unsigned char> fixed) const;

    /// Sets the targets of attached vertices at time t_t1 [s] and moves the anchors of springs. Colliders are
    /// already advanced.
    void update_targets(double t_t1, const std::vector<Collider>& colliders, View<Vec3> targets);

    /// Sets accelerations by gravity, damping and air [m/s^2], for a step of dt [s] that ends at t_t1 [s].
    void accelerate(double dt, double t_t1, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration);

    /// Begins a step of dt [s] that ends at t_t1 [s], at x, for energies that depend on its start or end.
    void begin_step(View<const Vec3> x, double dt, double t_t1);

    /// Sets the positions of state().
    void take(View<const Vec3> x);

    /// Discards data of earlier steps, for cloth that was moved by place().
    void forget();

    /// True if something other than contact moves it at time t [s].
    bool is_disturbed(double t) const;

    garment::StrainLimit& strain_limit() { return *strain_limit_; }
    const garment::StrainLimit& strain_limit() const { return *strain_limit_; }

private:
    void add_attachments(const Scene& scene, const std::vector<Collider>& colliders);
    void add_membranes(bool has_internal_friction, std::vector<std::shared_ptr<Energy>>& energies);
    void add_bending(bool has_internal_friction, std::vector<std::shared_ptr<Energy>>& energies);
    /// @param settings  their limit is replaced
    garment::ByFabric<garment::StrainLimit::Settings>
    strain_limits(const garment::StrainLimit::Settings& settings) const;
    void add_tension(OuterMethod outer, std::vector<std::shared_ptr<Energy>>& energies);
    std::vector<int> fold_hinges() const;
    void add_folds(std::vector<std::shared_ptr<Energy>>& energies);
    void add_springs(std::vector<std::shared_ptr<Energy>>& energies);
    void add_pressure(const std::function<void(const std::string&)>& warn);
    void add_sewing(std::vector<std::shared_ptr<Energy>>& energies) const;

    ClothState state_;
    std::string source_;
    Vec3 gravity_;
    scene::Wind wind_;
    garment::Gusts gusts_;
    scene::Sewing sewing_;
    std::vector<garment::Elastics::Spring> elastics_;
    std::unique_ptr<garment::Tacks> tacks_; ///< null without tacks
    std::vector<double> masses_;
    std::vector<AttachmentConstraint> attachments_;
    std::shared_ptr<const garment::RestShape> rest_;
    std::vector<FabricPart> parts_;
    std::shared_ptr<garment::BendDamping> bend_damping_; ///< null without internal friction
    std::vector<garment::FoldEdge> folds_;
    std::shared_ptr<garment::FoldLines> fold_lines_; ///< null without folds
    std::shared_ptr<garment::Springs> springs_;      ///< null without attachments by springs
    scene::Pressure overpressure_;
    std::shared_ptr<garment::Pressure> pressure_; ///< null without pressure
    std::unique_ptr<garment::Aerodynamics> air_;
    std::shared_ptr<garment::StretchTension> tension_; ///< null for a baseline method
    std::unique_ptr<garment::StrainLimit> strain_limit_;
    std::vector<Vec3> gusts_at_; ///< [vertices] [m/s]; empty in steady wind
};

} // namespace toile::scenes
