#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenes/colliders/attachment_constraint.h"

namespace toile::scenes {

/// What holds vertices of a cloth or soft body: an attachment or a core.
struct VertexOwner {
    std::string location;     ///< named in errors, e.g. "tablecloth.json: attachments[0]"
    View<const int> vertices; ///< ascending; borrowed
    bool is_at_rest;          ///< keeps its vertices where they are
};

VertexOwner owner_of(const AttachmentConstraint& attachment);

/// Owners at rest may share vertices.
/// @param object   cloth or soft body, named in errors
/// @param name_of  a vertex in errors, e.g. "vertex 3"
/// @throws InvalidInput for a vertex of two owners that may part
void require_one_owner(const std::vector<VertexOwner>& owners, const std::string& object,
                       const std::function<std::string(int vertex)>& name_of);

} // namespace toile::scenes
