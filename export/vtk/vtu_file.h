#pragma once

#include <string>
#include <vector>

#include "export/archive/frame_velocities.h"
#include "export/cache_layout.h"

namespace toile::exports {

/// A frame as VTK XML unstructured grid (.vtu): float positions, a cell for each polygon (VTK_TRIANGLE,
/// VTK_QUAD or VTK_POLYGON), optionally the point data "velocity", attributes as point data, and panels as
/// cell data with their names as field data. The arrays are raw and little endian behind the XML, each with
/// its size as UInt64.
class VtuFile {
public:
    explicit VtuFile(const CacheMesh& mesh);

    /// @param time    [s] stored as field data TimeValue
    /// @param sample  without velocities none are stored
    std::string bytes(double time, const MovingSample& sample) const;

private:
    class AppendedData;
    /// @return the elements that stand for the arrays
    std::string add_point_data(AppendedData& data, const MovingSample& sample) const;

    int polygon_count_;
    std::string connectivity_, offsets_, types_;
    std::vector<std::string> attributes_;
    std::string panels_, panel_names_; ///< numbers of the cells, and an element with their names
};

} // namespace toile::exports
