#pragma once

#include <memory>
#include <vector>

#include "collision/repair/start_report.h"
#include "core/base/stages.h"
#include "core/pd/step/step_report.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"
#include "scenes/world/snapshot.h"
#include "scenes/world/world_options.h"

namespace toile {
struct CudaDevice;
} // namespace toile

namespace toile::scenes {

/// A running scene: avatars, cloths, solids, contact and the time-step loop. The only class that combines
/// them all.
///
/// Sample k belongs to time k / fps. StepControl divides samples into time steps; stages that the scene does
/// not need are never entered (stages() shows it).
///
/// Calls throw InvalidUse on a World that was moved from; those that are not const also while another one
/// runs, on another thread or below it in a callback. A World that has failed (settle() or advance_frame()
/// threw, or reported a status NonFinite) may be in the middle of a sample; what would change it throws
/// InvalidUse with the reason.
class World {
public:
    /// Loads and places everything, and repairs a start pose with cloth inside avatars or through cloth
    /// (docs/theory/start_repair.md). Nothing is simulated or factored yet.
    /// @throws InvalidInput for unusable files, materials and selections, and as require_valid() and
    ///         open_backend()
    explicit World(const Scene& scene, const WorldOptions& options = {});
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Moves the vertices of a cloth to new positions, however far from its rest shape; velocities are kept.
    /// @param positions  [vertices] of that cloth [m]
    /// @throws InvalidUse for a cloth that does not exist or another number of vertices; InvalidInput for
    ///         coordinates that are not is_in_range()
    void place(int cloth, View<const Vec3> positions);

    /// Prepares the global solvers, which the first step would otherwise do: factors, and the tables of
    /// quadrature, seconds for 10 000 vertices. A step prepares again if attachments are released during the
    /// run.
    /// @throws Cancelled if WorldOptions::building or goes_on returns false. settle() and advance_frame()
    /// throw
    ///         it too; the sample in progress is then lost.
    void prepare();

    /// Simulates Scene::settle seconds with every avatar in its first pose. Before, cloth and
    /// bodies that the repair of the start pose has strained, or that start too near to a body, relax: stage
    /// "scenes/relax_start".
    /// @throws InvalidUse after advance_frame()
    StepReport settle();

    /// Simulates up to the next sample.
    StepReport advance_frame();

    int frame() const;       ///< current sample; starts at 0
    int frame_count() const; ///< samples of the scene

    /// States of the cloths at the current sample. On a GPU the call copies the positions and waits for them:
    /// views taken earlier keep old positions until then, and only one thread may call at a time.
    /// @throws DeviceError if the GPU no longer responds
    View<const ClothState> cloths() const;

    /// States of all cloths, then all solids, then the surfaces of all soft bodies, each in the order of the
    /// scene. See cloths().
    View<const ClothState> simulated() const;

    /// The same, and then the surfaces that soft bodies have for pictures and caches.
    View<const ClothState> surfaces() const;

    int vertex_count() const; ///< of all simulated surfaces, and inside soft bodies

    /// Tetrahedra of each soft body that are flat or inside out at the current sample [soft bodies].
    std::vector<int> inverted_tets() const;

    /// Current positions of surfaces(), without waiting for a GPU unless a soft body has a render surface.
    /// Must not outlive the World.
    std::shared_ptr<const Snapshot> snapshot() const;

    /// Defects of the start pose, and those that its repair left. surface_of() and body_of() in start_pose.h
    /// name what is numbered.
    const collision::StartReport& start() const;

    /// GPU on which it runs; null: the CPU.
    const CudaDevice* device() const;

    /// Calls and seconds of every stage so far.
    const Stages& stages() const;

private:
    struct Parts;
    class Call;
    Parts& parts() const;

    std::unique_ptr<Parts> parts_;
};

} // namespace toile::scenes
