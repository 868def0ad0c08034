#pragma once

#include <memory>
#include <vector>

#include "core/pd/energy.h"
#include "garment/energy/aerodynamics.h"
#include "garment/energy/device_loads.h"
#include "garment/energy/gusts.h"
#include "garment/energy/springs.h"
#include "garment/energy/strain_limit.h"
#include "garment/rivals/rival.h"
#include "scenes/hold.h"
#include "scenes/world.h"

namespace toile {

/// What the air of a scene does to cloth, without its gusts.
AirSettings air_of(const Scene& scene);
/// Those of a wind; still where it has none.
Gusts gusts_of(const scene::Wind& wind);

/// One cloth of a running scene: its fabric as energies, what holds it, the air around it, its strain limit.
/// It is moved by the ClothGroup that it belongs to; all arrays here are the cloth's own vertices.
class SceneCloth {
public:
    /// @throws InvalidInput for a mesh, fabric or attachment that does not work.
    SceneCloth(const Scene& scene, const scene::Cloth& settings, const std::vector<Obstacle>& obstacles,
               const WorldOptions& options);

    const ClothState& state() const { return state_; }
    int vertex_count() const { return int(state_.positions.size()); }
    const std::string& source() const { return source_; } ///< what errors call it
    const std::shared_ptr<const RestShape>& rest_shape() const { return rest_; }

    const std::vector<double>& masses() const { return masses_; } ///< [vertices] [kg]

    /// The terms of projective dynamics. Once: the limit on strain learns of the tension among them.
    std::vector<std::shared_ptr<Energy>> make_energies();

    /// Adds what accelerate() finds to the loads of a body on a GPU.
    void add_loads(DeviceLoads& loads, int first_vertex) const
    {
        loads.add(*rest_, masses_, state_.fabric.damping, first_vertex);
    }

    /// The same cloth for a rival method.
    ClothModel model() const;

    /// [vertices] nonzero for those that an attachment holds exactly, now or later.
    std::vector<char> held_exactly() const;

    /// Marks the vertices whose place is prescribed at time t_t1 [s]; the others are cleared.
    void mark_fixed(double t_t1, View<unsigned char> fixed) const;

    /// Prescribes held vertices at time t_t1 [s] and moves the far ends of springs; obstacles already
    /// advanced.
    void hold(double t_t1, const std::vector<Obstacle>& obstacles, View<Vec3> targets);

    /// Gravity, the fabric's damping, and the air [m/s^2], for a step of dt [s] that ends at t_t1 [s].
    void accelerate(double dt, double t_t1, View<const Vec3> x, View<const Vec3> v, View<Vec3> acceleration);

    /// Picks what is taut at the start of a step.
    void begin_step(View<const Vec3> x);

    /// Takes positions that the cloth has come to or was put to.
    void take(View<const Vec3> x);

    /// Drops what earlier steps left, for cloth that was put elsewhere.
    void forget();

    /// True when something other than contact moves it at time t [s].
    bool is_disturbed(double t) const;

    StrainLimit& strain_limit() { return *strain_limit_; }

private:
    void add_springs(std::vector<std::shared_ptr<Energy>>& energies);

    ClothState state_;
    std::string source_;
    Vec3 gravity_;
    scene::Wind wind_;
    Gusts gusts_;
    std::vector<double> masses_;
    std::vector<Hold> holds_;
    std::shared_ptr<const RestShape> rest_;
    std::shared_ptr<Springs> springs_; ///< null without attachments that give
    std::unique_ptr<Aerodynamics> air_;
    std::shared_ptr<StretchTension> tension_; ///< null for a rival
    std::unique_ptr<StrainLimit> strain_limit_;
    std::vector<Vec3> gusts_at_; ///< [vertices] [m/s]; empty in steady wind
};

} // namespace toile
