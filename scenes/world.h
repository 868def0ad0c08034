#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "collision/untangle/start_report.h"
#include "core/backend/stages.h"
#include "core/mesh/obj.h"
#include "core/pd/step_report.h"
#include "garment/fabric/fabric.h"
#include "scenes/backend.h"
#include "scenes/format/scene.h"
#include "scenes/snapshot.h"

namespace toile {

class TableStore;

/// A cloth of a running scene as others see it, or the surface of a solid.
struct ClothState {
    std::string name;
    std::vector<Vec3> positions; ///< [vertices] now [m]
    std::vector<Triangle> triangles;
    ObjMesh rest;  ///< start placement, rest lengths, faces and texture coordinates as stored
    Fabric fabric; ///< of a solid: none, and a strain limit of 0
    int turned_faces =
        0; ///< faces of the file that were wound against their neighbours; `rest` has them right
};

/// How a World prepares its global solvers, beyond what the scene says.
struct WorldOptions {
    Backend backend = Backend::Cpu;
    int device = 0; ///< number of the GPU that Backend::Cuda and Auto take (cuda_devices())

    /// Where quadrature tables come from; null: TableStore::of_process(), which keeps them on disk.
    std::shared_ptr<TableStore> tables = nullptr;

    /// Called with a cloth's name and the finished share [0, 1] of its tables while they are built, from any
    /// of the building threads. Returning false ends the call that builds with Cancelled. May be empty.
    std::function<bool(const std::string& cloth, double share)> building = nullptr;

    /// Told what went wrong without stopping the run, e.g. a damaged cache file; may be empty.
    std::function<void(const std::string&)> warn = nullptr;
};

/// A running scene: avatars, cloths, solids, contact and the time-step loop. The only place that knows them
/// all.
///
/// Sample k belongs to time k / fps. Each sample takes Solver::substeps implicit Euler steps; stages that the
/// scene does not need are never entered (stages() shows it).
class World {
public:
    /// Loads everything and places it, and repairs a start pose with cloth inside avatars or through cloth
    /// (docs/collision/start_repair.md); nothing is simulated or factored yet.
    /// @throws InvalidInput for files, materials and selections that do not work; as open_backend().
    explicit World(const Scene& scene, const WorldOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Puts the vertices of a cloth elsewhere, however far from its rest shape; velocities stay.
    /// @param positions  [vertices] of that cloth [m]
    void place(int cloth, View<const Vec3> positions);

    /// Prepares the global solvers for the first step, which otherwise would: factors, and the tables of
    /// quadrature, seconds for 10 000 vertices. Where holds let go during the run, a step prepares again.
    /// @throws Cancelled where WorldOptions::building wants no more. settle() and advance_frame() do so too;
    /// the sample they were at is then lost.
    void prepare();

    /// Simulates Scene::settle seconds with every avatar in its first pose. Call before sample 0 is taken.
    StepReport settle();

    /// Simulates up to the next sample.
    StepReport advance_frame();

    int frame() const;       ///< sample that positions belong to; starts at 0
    int frame_count() const; ///< samples of the scene

    /// Where a GPU makes the steps, a sample's positions are copied when they are asked for, which waits for
    /// it: states from before it show nothing of it until then, and only one thread may ask at a time.
    /// @throws DeviceError where the GPU no longer answers
    View<const ClothState> cloths() const;

    /// All cloths and then all solids, each in the order of the scene. As cloths().
    View<const ClothState> surfaces() const;

    /// Where surfaces() are now, without waiting for a GPU. It must not outlive the World.
    std::shared_ptr<const Snapshot> snapshot() const;

    /// What the start pose had inside avatars and through cloth, and what its repair left. Cloths and bodies
    /// are numbered as in Scene::cloths and Scene::avatars.
    const StartReport& start() const;

    /// The GPU that it runs on; null: the CPU.
    const CudaDevice* device() const;

    /// Calls and seconds of every stage so far.
    const Stages& stages() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

} // namespace toile
