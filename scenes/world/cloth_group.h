#pragma once

#include <memory>
#include <vector>

#include "collision/contact/contact.h"
#include "core/pd/energy/leading_active_set.h"
#include "core/pd/rigid/rigid_active_set.h"
#include "core/pd/step/point_masses.h"
#include "garment/energy/strain_limit/joint_strain_limit.h"
#include "scenes/world/bodies/scene_bodies.h"
#include "scenes/world/scene_cloth.h"
#include "scenes/world/snapshot.h"

namespace toile::garment {
class DeviceLoads;
} // namespace toile::garment

namespace toile::scenes {

/// Cloths, soft bodies and solids that may collide, simulated together. One minimisation per step over all
/// vertices of cloth, numbered cloth after cloth, followed by the vertices of the surfaces of soft bodies,
/// the unknowns of the solids (RigidBodies), and the vertices inside soft bodies.
class ClothGroup {
public:
    /// @throws InvalidInput if the scene's method does not support one of the cloths.
    /// @param bodies  of the whole scene, in its only group; of several groups, none
    /// @param space   GPU on which steps are minimised, borrowed; null: the CPU
    ClothGroup(const Scene& scene, std::vector<SceneCloth> cloths, SceneBodies bodies,
               const std::vector<Collider>& colliders, const WorldOptions& options, const CudaSpace* space);

    /// Cloths with their start positions, as changed by place().
    const std::vector<SceneCloth>& cloths() const { return cloths_; }

    /// Current positions of one cloth, valid until the next step [m]. Copied from the GPU if there is one.
    View<const Vec3> positions_of(int cloth) const;

    /// Adds all cloths, solids and soft bodies in their current state, without waiting for the GPU, and then
    /// the render surfaces of soft bodies, which wait for it.
    void add_to(Snapshot& snapshot) const;

    const SceneSolids* solids() const { return solids_.get(); }               ///< null: none
    const SceneSoftBodies* soft_bodies() const { return soft_bodies_.get(); } ///< null: none
    View<const Vec3> surface_of_soft_body(int body) const;                    ///< as positions_of()
    std::vector<Vec3> render_positions_of(int soft_body) const; ///< see SceneSoftBodies::render_positions()
    int inverted_tets_of(int soft_body) const;                  ///< see SceneSoftBodies::inverted_count()

    /// Attaches cloth where it is. See SceneCloth::tie.
    void tie(double gap, const std::vector<Collider>& colliders,
             const std::function<void(const std::string&)>& warn);

    /// Prepares the global solvers for a step of dt [s] that ends at time t_t1 [s].
    void prepare(double dt, double t_t1);

    /// Takes one time step of dt [s] that ends at time t_t1 [s]. Colliders are already advanced to it.
    /// @param max_error  [m] see PointMasses::refuse_steps_beyond
    StepReport step(double dt, double t_t1, const std::vector<Collider>& colliders, double max_error);

    /// True if cloth is strained beyond its limit.
    bool is_strained() const;

    /// @param shortest_step  [s] soft bodies through which sound passes in less are hit as a whole
    void find_stiff_parts(double shortest_step);

    /// Lets relaxation at the start go on until vertices of a cloth rest, or a soft body, or a solid.
    void unsettle(int cloth, View<const int> vertices);
    void unsettle_soft_body(int body);
    void unsettle_solid(int solid);

    /// True while relax() still moves unsettled vertices, or soft bodies that place_soft_bodies() has
    /// deformed.
    bool is_unsettled() const { return !unsettled_.empty(); }

    /// Takes a step from rest, without gravity and air: everything relaxes and goes nowhere. Velocities stay.
    StepReport relax(double dt, double t_t1, const std::vector<Collider>& colliders);

    /// Declares that no cloth crosses cloth in the start pose: the first step skips that search, unless there
    /// are solids, which cloth may cross.
    void assume_no_crossings()
    {
        may_cross_ = solids_ != nullptr || (contact_ && contact_->bodies());
        may_cross_cloth_ = solids_ != nullptr;
    }

    /// Moves the vertices of one cloth to new positions; velocities and rest shape are kept.
    void place(int cloth, View<const Vec3> positions);

    /// Moves the surfaces of soft bodies at the start, where they differ; see SceneSoftBodies::place().
    /// @param surfaces  [soft bodies] positions of all vertices [m]
    void place_soft_bodies(const std::vector<std::vector<Vec3>>& surfaces);

private:
    std::unique_ptr<PointMasses> make_body(const Scene& scene, const WorldOptions& options);
    std::unique_ptr<DeviceSolver> make_device_solver(scene::SolverMethod method, const WorldOptions& options,
                                                     const CudaSpace& space) const;
    std::unique_ptr<PointMasses> make_device_body(const Scene& scene, const WorldOptions& options,
                                                  const CudaSpace& space);
    struct Start {
        std::vector<Vec3> positions, velocities; ///< [unknowns] [m], [m/s]
        std::vector<double> masses;              ///< [unknowns] [kg]
    };
    Start start() const;
    std::vector<std::shared_ptr<Energy>> make_energies(OuterMethod outer);
    std::unique_ptr<garment::DeviceLoads> make_loads(const Scene& scene, const CudaSpace& space) const;
    std::unique_ptr<collision::Contact>
    make_contact(const Scene& scene, const std::vector<Collider>& colliders, const CudaSpace* space);
    int unknown_count() const;
    std::vector<Vec3> surfaces() const;
    void restart_from(View<const Vec3> x);
    void forget_rest();
    template <typename T>
    View<T> part(View<T> all, int cloth) const;
    void mark_fixed(double t_t1);
    void accelerate(double dt, double t_t1);
    ActiveSetEnergy* active() const;
    void begin_solids(double dt);
    void end_solids();
    void unsettle_surface(int first, size_t count);
    void mark_crossings();
    std::vector<unsigned char> mark_inside(const collision::BodySurfaces& bodies, View<const Vec3> x) const;
    int solid_of(int triangle) const;
    std::string names() const;
    void judge(double t_t1, const std::vector<Collider>& colliders, StepReport& report);
    void find_strained(double t_t1, const std::vector<Collider>& colliders, StepReport& report) const;
    void find_displaced(const std::vector<Collider>& colliders, StepReport& report) const;
    std::string place_of(int vertex, const std::vector<Collider>& colliders) const;
    void watch_rest(bool is_stuck, double dt);
    bool has_moved(View<const Vec3> from, View<const Vec3> to) const;
    bool is_asleep(double t_t1, const std::vector<Collider>& colliders);

    scene::Sleep sleep_;
    std::vector<SceneCloth> cloths_;
    std::unique_ptr<SceneSolids> solids_;          ///< null: none
    std::unique_ptr<SceneSoftBodies> soft_bodies_; ///< null: none
    std::vector<int> first_;                       ///< [cloths + 1] first vertex of each cloth
    int first_solid_ = 0; ///< unknown, after the vertices of all surfaces that deform
    std::unique_ptr<garment::JointStrainLimit> limits_;
    std::unique_ptr<collision::Contact> contact_; ///< null if nothing can collide
    std::unique_ptr<RigidActiveSet>
        rigid_contact_; ///< contact_ with the solids' unknowns; null without solids
    std::unique_ptr<LeadingActiveSet>
        surface_contact_; ///< the same in all unknowns; null without soft bodies
    std::unique_ptr<PointMasses> body_;
    bool is_relaxing_ = false;              ///< within relax()
    std::vector<int> unsettled_;            ///< of surfaces(); see is_unsettled()
    garment::DeviceLoads* loads_ = nullptr; ///< owned by body_, on a GPU; null: accelerate()
    std::vector<unsigned char> fixed_;
    std::vector<Vec3> targets_, acceleration_;
    std::vector<Triangle> triangles_; ///< of all cloths, then of all solids
    bool may_cross_ = true;           ///< cloth is known to cross cloth or bodies, or has been placed
    bool may_cross_cloth_ = true;     ///< false: the next look finds no cloth that crosses cloth
    bool has_jump_ = false;           ///< a body or core jumps in this step
    bool has_cloth_inside_ = false;   ///< cloth was inside a body when last looked at
    int crossing_bodies_ = 0;         ///< triangles of cloth that crossed bodies when last looked at
    int first_crossing_ = -1;         ///< a vertex of the first of them
    double still_time_ = 0.0;         ///< [s] since still_
    std::vector<Vec3> still_;         ///< [surfaces] where everything has stayed since [m]; empty: it moves
};

/// The cloths of a scene, in its order.
std::vector<SceneCloth> make_cloths(const Scene& scene, const std::vector<Collider>& colliders,
                                    const WorldOptions& options);

/// Groups the cloths: one group of all if they may collide, else one each. Solids belong to the group of all.
/// @param space  see ClothGroup
std::vector<ClothGroup> make_groups(const Scene& scene, std::vector<SceneCloth> cloths, SceneBodies bodies,
                                    const std::vector<Collider>& colliders, const WorldOptions& options,
                                    const CudaSpace* space);

} // namespace toile::scenes
