#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "garment/energy/fold/fold_edge.h"
#include "garment/energy/rest_shape.h"
#include "garment/seam/elastics.h"
#include "garment/seam/tacks.h"
#include "scenes/colliders/collider.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// A cloth as its scene describes it, before anything moves it.
struct LoadedCloth {
    ClothState state; ///< in the start placement, with its attachments in the order of the scene
    std::shared_ptr<const garment::RestShape> rest;
    std::vector<garment::Elastics::Spring> elastics;
    std::vector<garment::FoldEdge> folds;
    std::vector<garment::Tacks::Tack> tacks;
    std::string note; ///< what was chosen for the scene, with the name of the mesh; empty: nothing
};

/// Reads or cuts a cloth and selects its attached vertices.
/// @param colliders  those that attachments select near to, or more
/// @param warn       receives what was changed in the mesh; may be empty
/// @throws InvalidInput for a mesh, fabric, fold, tack or selection that does not work
LoadedCloth load_cloth(const Scene& scene, const scene::Cloth& settings,
                       const std::vector<Collider>& colliders,
                       const std::function<void(const std::string&)>& warn);

/// Name of an attachment in errors: tablecloth.json: attachments[0].
std::string attachment_location(const Scene& scene, size_t attachment);

/// Surfaces of a scene as they start, unrepaired: World's surfaces(), without loading what moves them.
/// @throws InvalidInput as load_cloth() and load_solid()
std::vector<ClothState> load_surfaces(const Scene& scene);

} // namespace toile::scenes
