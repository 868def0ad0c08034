#pragma once

#include <array>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "core/mesh/topology.h"
#include "scenes/surfaces/cloth_state.h"

namespace toile::scenes {

/// Finds edges of a cloth along paths of vertices.
class EdgePaths {
public:
    /// Both are kept by reference.
    EdgePaths(const ClothState& cloth, const Topology& topology);

    /// Edges between vertices that follow each other, as indices into Topology::edges. Where more than two
    /// faces share one, an edge inside is preferred to those at the border.
    /// @param vertices  of the file
    /// @param location  key of the path, for messages
    /// @param remedy    for vertices without a face: what to do with vertices of the surface
    /// @throws InvalidInput naming the place in the path, for a vertex that does not exist and for two that
    /// no
    ///         edge joins, with those that one does
    std::vector<int> along(const std::vector<int>& vertices, const std::string& location,
                           const std::string& remedy) const;

private:
    std::set<int> neighbours(int vertex) const;

    const ClothState& cloth_;
    const Topology& topology_;
    std::map<std::array<int, 2>, int> edges_; ///< by their vertices, ascending
};

} // namespace toile::scenes
