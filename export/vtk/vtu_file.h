#pragma once

#include <string>

#include "core/compute/types.h"
#include "core/mesh/obj.h"

namespace toile::exports {

/// A frame as VTK XML unstructured grid (.vtu): float positions, a cell for each polygon (VTK_TRIANGLE,
/// VTK_QUAD or VTK_POLYGON), and optionally the point data "velocity". The arrays are raw and little endian
/// behind the XML, each with its size as UInt64.
class VtuFile {
public:
    explicit VtuFile(const ObjMesh& faces);

    /// @param time         [s] stored as field data TimeValue
    /// @param positions    [vertices]
    /// @param velocities   [vertices] per second; empty: none are stored
    std::string bytes(double time, View<const Vec3> positions, View<const Vec3> velocities) const;

private:
    int polygon_count_;
    std::string connectivity_, offsets_, types_;
};

} // namespace toile::exports
