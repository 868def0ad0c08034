#pragma once

#include <string>
#include <vector>

#include "core/mesh/obj.h"

namespace toile::exports {

/// Which group each face of a mesh belongs to, such as a panel.
struct FacePanels {
    std::vector<int> of_face;       ///< [faces] into names
    std::vector<std::string> names; ///< of the groups; "other" for faces without one
};

/// Name that they have as an attribute of faces.
inline constexpr const char* kPanelAttribute = "panel";

/// Groups that have faces, in the order of their first face, wherever they begin anew.
FacePanels face_panels(const ObjMesh& faces);

} // namespace toile::exports
