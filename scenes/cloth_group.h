#pragma once

#include <memory>
#include <vector>

#include "collision/contact.h"
#include "core/pd/point_masses.h"
#include "core/pd/rigid_active_set.h"
#include "garment/energy/joint_strain_limit.h"
#include "scenes/scene_cloth.h"
#include "scenes/scene_solids.h"
#include "scenes/snapshot.h"

namespace toile {

/// Cloths and solids that may touch each other, moved together: one minimisation per step over all vertices
/// of cloth, numbered cloth after cloth, and then the unknowns of the solids (RigidBodies).
class ClothGroup {
public:
    /// @throws InvalidInput where the scene's method does not work on one of the cloths.
    /// @param solids  null: none
    /// @param space   where steps are minimised, borrowed; null: on the CPU
    ClothGroup(const Scene& scene, std::vector<SceneCloth> cloths, std::unique_ptr<SceneSolids> solids,
               const std::vector<Obstacle>& obstacles, const WorldOptions& options, const CudaSpace* space);

    /// Their states have the positions of the start and what place() puts elsewhere.
    const std::vector<SceneCloth>& cloths() const { return cloths_; }

    /// Positions of one cloth now, good until the next step [m]. They are copied from the GPU that has them.
    View<const Vec3> positions_of(int cloth) const;

    /// Adds all cloths as they are now. Nothing is waited for.
    void add_cloths_to(Snapshot& snapshot) const;

    const SceneSolids* solids() const { return solids_.get(); } ///< null: none

    /// Prepares the global solvers for a step of dt [s] that ends at time t_t1 [s].
    void prepare(double dt, double t_t1);

    /// One time step of dt [s] that ends at time t_t1 [s], obstacles already advanced to it.
    StepReport step(double dt, double t_t1, const std::vector<Obstacle>& obstacles);

    /// Tells that no cloth crosses cloth as they are placed now: it need not be looked for in the first step,
    /// unless there are solids, which it may cross.
    void know_no_crossings() { may_cross_ = solids_ != nullptr; }

    /// Puts the vertices of one cloth elsewhere; velocities and rest shape stay.
    void place(int cloth, View<const Vec3> positions);

private:
    std::unique_ptr<PointMasses> make_body(const Scene& scene, const WorldOptions& options);
    std::unique_ptr<PointMasses> make_device_body(const Scene& scene, const WorldOptions& options,
                                                  const CudaSpace& space);
    std::vector<double> masses() const;
    std::vector<std::shared_ptr<Energy>> make_energies();
    std::unique_ptr<DeviceLoads> make_loads(const Scene& scene, const CudaSpace& space) const;
    std::unique_ptr<Contact> make_contact(const Scene& scene, const std::vector<Obstacle>& obstacles,
                                          const CudaSpace* space);
    std::vector<Vec3> start_positions() const;
    std::vector<Vec3> surfaces() const;
    template <typename T>
    View<T> part(View<T> all, int cloth) const;
    void mark_fixed(double t_t1);
    void accelerate(double dt, double t_t1);
    ActiveSetEnergy* active() const;
    void begin_solids(double dt);
    void end_solids();
    void look_for_crossings();
    int solid_of(int triangle) const;
    std::string names() const;
    bool sleeps(double t_t1, const std::vector<Obstacle>& obstacles);

    scene::Sleep sleep_;
    std::vector<SceneCloth> cloths_;
    std::unique_ptr<SceneSolids> solids_; ///< null: none
    std::vector<int> first_;              ///< [cloths + 1] vertices
    std::unique_ptr<JointStrainLimit> limits_;
    std::unique_ptr<Contact> contact_; ///< null where there is nothing to touch
    std::unique_ptr<RigidActiveSet>
        rigid_contact_; ///< contact_ as the minimiser sees it; null without solids
    std::unique_ptr<PointMasses> body_;
    DeviceLoads* loads_ = nullptr; ///< body_'s, on a GPU; null: accelerate()
    std::vector<unsigned char> fixed_;
    std::vector<Vec3> targets_, acceleration_;
    std::vector<Triangle> triangles_; ///< of all cloths and then all solids
    bool may_cross_ = true;           ///< cloth is known to cross cloth, or has been put anywhere
    double rest_time_ = 0.0;          ///< [s] since when every vertex has been slow
};

/// The cloths of a scene, one by one.
std::vector<SceneCloth> make_cloths(const Scene& scene, const std::vector<Obstacle>& obstacles,
                                    const WorldOptions& options);

/// Sorts them into groups: one of all where they may touch each other, else one each. Solids are in the one
/// of all.
/// @param space  as ClothGroup's
std::vector<ClothGroup> make_groups(const Scene& scene, std::vector<SceneCloth> cloths,
                                    const std::vector<Obstacle>& obstacles, const WorldOptions& options,
                                    const CudaSpace* space);

} // namespace toile
