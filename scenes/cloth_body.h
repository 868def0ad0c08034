#pragma once

#include <memory>
#include <vector>

#include "collision/contact.h"
#include "core/pd/point_masses.h"
#include "garment/energy/aerodynamics.h"
#include "garment/energy/gusts.h"
#include "garment/energy/springs.h"
#include "garment/energy/strain_limit.h"
#include "scenes/hold.h"
#include "scenes/world.h"

namespace toile {

/// One cloth of a running scene: fabric, energies, holds, contact, and the point masses that are stepped.
class ClothBody {
public:
    /// @throws InvalidInput for a mesh, fabric or attachment that does not work.
    ClothBody(const Scene& scene, const scene::Cloth& settings, const std::vector<Obstacle>& obstacles,
              const WorldOptions& options);

    /// Prepares the global solver for a step of dt [s] that ends at time t_t1 [s].
    void prepare(double dt, double t_t1);

    /// One time step of dt [s] that ends at time t_t1 [s], obstacles already advanced to it.
    StepReport step(double dt, double t_t1, const std::vector<Obstacle>& obstacles);

    /// Puts the vertices elsewhere; velocities and rest shape stay.
    void place(View<const Vec3> positions);

    const ClothState& state() const { return state_; }

    /// [vertices] nonzero for those that an attachment holds exactly, now or later.
    std::vector<char> held_exactly() const;

private:
    /// @param unmoved  [vertices] rest positions before the cloth's translation [m]
    void build(const Scene& scene, const std::vector<Vec3>& unmoved, const std::vector<Obstacle>& obstacles,
               const WorldOptions& options, const std::string& source, double grain);
    std::unique_ptr<PointMasses> make_body(const Scene& scene, const std::shared_ptr<const RestShape>& rest,
                                           const WorldOptions& options, const std::string& source);
    std::unique_ptr<PointMasses> make_rival(const Scene& scene, std::shared_ptr<const RestShape> rest) const;
    std::vector<double> vertex_masses(const RestShape& rest) const;
    void mark_fixed(double t_t1);
    void hold(double t_t1, const std::vector<Obstacle>& obstacles);
    void accelerate(double dt, double t_t1);
    bool sleeps(double t_t1, const std::vector<Obstacle>& obstacles);

    ClothState state_;
    Vec3 gravity_;
    scene::Wind wind_;
    Gusts gusts_;
    scene::Sleep sleep_;
    std::vector<Hold> holds_;
    std::shared_ptr<Springs> springs_; ///< null without attachments that give
    std::unique_ptr<Aerodynamics> air_;
    std::shared_ptr<StretchTension> tension_; ///< null for a rival
    std::unique_ptr<StrainLimit> strain_limit_;
    std::unique_ptr<Contact> contact_; ///< null without obstacles
    std::unique_ptr<PointMasses> body_;
    std::vector<unsigned char> fixed_;
    std::vector<Vec3> targets_, acceleration_;
    std::vector<Vec3> gusts_at_; ///< [vertices] [m/s]; empty in steady wind
    double rest_time_ = 0.0;     ///< [s] since when every vertex has been slow
};

} // namespace toile
