#pragma once

#include <string>
#include <vector>

#include "scenes/drape/drape.h"
#include "scenes/drape/drape_watch.h"
#include "scenes/drape/garment.h"

namespace toile::scenes {

/// Labels of edges that stay attached to the body: nothing else holds them up.
bool stays_attached(const std::string& label);

/// Makes the scenes of a drape's stages, and writes their meshes into the folder.
class StageScenes {
public:
    /// All are kept by reference.
    /// @param worn   [garments below] they do not move but where the garment hangs
    /// @param watch  is told when a stage begins
    StageScenes(const DrapeSettings& settings, const Garment& garment, const std::vector<WornGarment>& worn,
                DrapeWatch& watch);

    /// The panels fold along their folds, without gravity.
    Scene fold(const GarmentSurface& panels) const;

    /// Threads pull the seams shut, without gravity. The panels give way to the body as jersey does, and move
    /// so slowly that they stop where no force pulls.
    /// @param panels  with lines as threads
    /// @param tacks  of its vertices; those without a time close
    Scene sew(const GarmentSurface& panels, std::vector<scene::Tack> tacks) const;

    /// Unfolds the seams, along which panels lie on each other when they meet, as an iron does: cloth of
    /// great bending rigidity, without gravity.
    /// @param x  [welded vertices] [m]
    Scene press(const GarmentMesh& mesh, View<const Vec3> x) const;

    /// The welded garment falls into place, with labelled edges held by springs.
    /// @param x  [welded vertices] [m]
    Scene settle(const GarmentMesh& mesh, View<const Vec3> x) const;

    /// The garment hangs on the body and those below it, in motion that is damped: rest is the same as
    /// without damping.
    /// @param x          [welded vertices] [m]
    /// @param holds_all  labelled edges that are released in the end are held too, by springs
    /// @param time       that gravity has acted on the garment [s]
    Scene hang(const GarmentMesh& mesh, View<const Vec3> x, bool holds_all, double time) const;

private:
    /// What becomes of a preset in a stage.
    using FabricInStage = scene::Fabric(const std::string& preset);

    Scene scene_of(const std::string& stage, const GarmentSurface& surface, FabricInStage* fabric) const;
    Scene still_scene_of(const std::string& stage, const GarmentSurface& surface,
                         FabricInStage* fabric) const;
    void add_cloth(Scene& scene, const Garment& garment, const std::string& file_name,
                   const GarmentSurface& surface, FabricInStage* fabric) const;
    void hold(const Garment& garment, const GarmentMesh& mesh, Scene& scene, bool holds_all) const;

    const DrapeSettings& settings_;
    const Garment& garment_;
    const std::vector<WornGarment>& worn_;
    DrapeWatch& watch_;
};

} // namespace toile::scenes
