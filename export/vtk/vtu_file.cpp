#include "export/vtk/vtu_file.h"

#include <cstdint>

#include "core/base/number.h"
#include "export/byte_order.h"

namespace toile::exports {

namespace {

constexpr std::uint8_t kTriangle = 5, kPolygon = 7, kQuad = 9; // of VTK

std::uint8_t cell_type(size_t corners) { return corners == 3 ? kTriangle : corners == 4 ? kQuad : kPolygon; }

/// Field data of texts: the codes of their bytes, and a zero behind each.
std::string text_array(const std::string& name, const std::vector<std::string>& texts)
{
    std::string array = "<Array type=\"String\" Name=\"" + name + "\" NumberOfTuples=\"" +
                        std::to_string(texts.size()) + "\" format=\"ascii\">";
    for (const std::string& text : texts) {
        for (const char c : text)
            array += std::to_string(static_cast<unsigned char>(c)) + " ";
        array += "0 ";
    }
    return array + "</Array>\n";
}

} // namespace

/// Arrays behind the XML, which names each by its offset.
class VtuFile::AppendedData {
public:
    /// @return the element that stands for the array
    std::string add(const std::string& type, const std::string& name, int components,
                    const std::string& array)
    {
        std::string element = "<DataArray type=\"" + type + "\" Name=\"" + name + "\" NumberOfComponents=\"" +
                              std::to_string(components) + "\" format=\"appended\" offset=\"" +
                              std::to_string(bytes_.size()) + "\"/>\n";
        append(bytes_, std::uint64_t(array.size()));
        bytes_ += array;
        return element;
    }

    const std::string& bytes() const { return bytes_; }

private:
    std::string bytes_;
};

VtuFile::VtuFile(const CacheMesh& mesh)
    : polygon_count_(int(mesh.faces.polygons.size())), attributes_(mesh.attributes)
{
    std::int64_t offset = 0;
    for (const std::vector<int>& polygon : mesh.faces.polygons) {
        for (const int v : polygon)
            append(connectivity_, std::int64_t(v));
        append(offsets_, offset += std::int64_t(polygon.size()));
        append(types_, cell_type(polygon.size()));
    }
    for (const int panel : mesh.panels.of_face)
        append(panels_, std::int32_t(panel));
    if (!panels_.empty())
        panel_names_ = text_array(std::string(kPanelAttribute) + "_names", mesh.panels.names);
}

std::string VtuFile::add_point_data(AppendedData& data, const MovingSample& sample) const
{
    std::string elements;
    if (!sample.velocities.empty())
        elements += data.add("Float32", "velocity", 3, bytes_of(sample.velocities));
    const int count = sample.positions.size();
    for (size_t k = 0; k < attributes_.size(); ++k)
        elements += data.add("Float32", attributes_[k], 1,
                             bytes_of(sample.attributes.subview(int(k) * count, count)));
    return elements;
}

std::string VtuFile::bytes(double time, const MovingSample& sample) const
{
    AppendedData data;
    std::string xml =
        "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" "
        "byte_order=\"LittleEndian\" header_type=\"UInt64\">\n<UnstructuredGrid>\n"
        "<FieldData><DataArray type=\"Float64\" Name=\"TimeValue\" NumberOfTuples=\"1\" "
        "format=\"ascii\">" +
        shortest_text(time) + "</DataArray>" + panel_names_ + "</FieldData>\n<Piece NumberOfPoints=\"" +
        std::to_string(sample.positions.size()) + "\" NumberOfCells=\"" + std::to_string(polygon_count_) +
        "\">\n<Points>\n" + data.add("Float32", "Points", 3, bytes_of(sample.positions)) +
        "</Points>\n<Cells>\n" + data.add("Int64", "connectivity", 1, connectivity_) +
        data.add("Int64", "offsets", 1, offsets_) + data.add("UInt8", "types", 1, types_) + "</Cells>\n";
    const std::string point_data = add_point_data(data, sample);
    if (!point_data.empty())
        xml += (sample.velocities.empty() ? "<PointData>\n" : "<PointData Vectors=\"velocity\">\n") +
               point_data + "</PointData>\n";
    if (!panels_.empty())
        xml += "<CellData>\n" + data.add("Int32", kPanelAttribute, 1, panels_) + "</CellData>\n";
    xml += "</Piece>\n</UnstructuredGrid>\n<AppendedData encoding=\"raw\">\n_";
    return xml + data.bytes() + "\n</AppendedData>\n</VTKFile>\n";
}

} // namespace toile::exports
