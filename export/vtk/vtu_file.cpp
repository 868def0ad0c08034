#include "export/vtk/vtu_file.h"

#include <cstdint>

#include "core/base/number.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::uint8_t kTriangle = 5, kPolygon = 7, kQuad = 9; // of VTK

std::uint8_t cell_type(size_t corners) { return corners == 3 ? kTriangle : corners == 4 ? kQuad : kPolygon; }

std::string bytes_of(View<const Vec3> vectors)
{
    std::string bytes;
    bytes.reserve(12 * size_t(vectors.size()));
    for (const Vec3& vector : vectors)
        for (const double coordinate : vector)
            append(bytes, float(coordinate));
    return bytes;
}

/// Arrays behind the XML, which names each by its offset.
class AppendedData {
public:
    /// @return the element that stands for the array
    std::string add(const std::string& type, const std::string& name, int components,
                    const std::string& array)
    {
        const std::string element = "<DataArray type=\"" + type + "\" Name=\"" + name +
                                    "\" NumberOfComponents=\"" + std::to_string(components) +
                                    "\" format=\"appended\" offset=\"" + std::to_string(bytes_.size()) +
                                    "\"/>\n";
        append(bytes_, std::uint64_t(array.size()));
        bytes_ += array;
        return element;
    }

    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

} // namespace

VtuFile::VtuFile(const ObjMesh& faces) : polygon_count_(int(faces.polygons.size()))
{
    std::int64_t offset = 0;
    for (const std::vector<int>& polygon : faces.polygons) {
        for (const int v : polygon)
            append(connectivity_, std::int64_t(v));
        append(offsets_, offset += std::int64_t(polygon.size()));
        append(types_, cell_type(polygon.size()));
    }
}

std::string VtuFile::bytes(double time, View<const Vec3> positions, View<const Vec3> velocities) const
{
    AppendedData data;
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
        "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">" +
        shortest_text(time) + "</DataArray></FieldData>\n<Piece NumberOfPoints=\"" +
        std::to_string(positions.size()) + "\" NumberOfCells=\"" + std::to_string(polygon_count_) +
        "\">\n<Points>\n" + data.add("Float32", "Points", 3, bytes_of(positions)) + "</Points>\n<Cells>\n" +
        data.add("Int64", "connectivity", 1, connectivity_) + data.add("Int64", "offsets", 1, offsets_) +
        data.add("UInt8", "types", 1, types_) + "</Cells>\n";
    if (velocities.size() > 0)
        xml += "<PointData Vectors=\"velocity\">\n" +
               data.add("Float32", "velocity", 3, bytes_of(velocities)) + "</PointData>\n";
    xml += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    return xml + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

} // namespace toile::exports
