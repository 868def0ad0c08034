#include "avatars/appearance/obj_appearance.h"

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <sstream>

#include "core/mesh/obj.h"

namespace toile::avatars {

namespace {

constexpr double kHalf = 0.5; ///< [-] alpha below which a masked image is cut out

/// Calls `visit` with keyword, rest and number (from 1) of each line; lines end with LF, CR or both.
void for_each_line(
    const std::filesystem::path& file,
    const std::function<void(const std::string& keyword, std::istringstream& rest, int line)>& visit)
{
    std::ifstream stream(file, std::ios::binary);
    const std::string text{std::istreambuf_iterator<char>(stream), {}};
    for (size_t begin = 0, line = 1; begin < text.size(); ++line) {
        const size_t end = std::min(text.find_first_of("\r\n", begin), text.size());
        std::istringstream rest(text.substr(begin, end - begin));
        if (std::string keyword; rest >> keyword)
            visit(keyword, rest, int(line));
        begin = end + (text.compare(end, 2, "\r\n") == 0 ? 2 : 1);
    }
}

/// What is left of a line, without blanks around it.
std::string name_in(std::istringstream& rest)
{
    std::string name;
    std::getline(rest >> std::ws, name);
    name.erase(name.find_last_not_of(" \t") + 1);
    return name;
}

/// Number of values after each option of a texture line.
const std::map<std::string, int> kOptions{
    {"-blendu", 1}, {"-blendv", 1}, {"-boost", 1}, {"-bm", 1}, {"-cc", 1},     {"-clamp", 1}, {"-imfchan", 1},
    {"-mm", 2},     {"-o", 3},      {"-s", 3},     {"-t", 3},  {"-texres", 1}, {"-type", 1}};

/// Reads "-clamp on skin.png".
/// @return name of the image
std::string read_texture(std::istringstream& rest, Texture& texture)
{
    for (std::string name = name_in(rest);;) {
        std::istringstream words(name);
        std::string option, value;
        words >> option;
        const auto known = kOptions.find(option);
        if (known == kOptions.end())
            return name;
        for (int i = 0; i < known->second; ++i)
            words >> value;
        if (option == "-clamp" && value == "on")
            texture.wrap = {Wrap::Clamp, Wrap::Clamp};
        name = name_in(words);
    }
}

/// Adds the materials of a .mtl file to the appearance.
void read_materials(const std::filesystem::path& file, Appearance& appearance,
                    std::map<std::string, int>& index_of_name)
{
    appearance.files.push_back(file);
    SurfaceMaterial ignored; // of lines before the first material
    const auto current = [&]() -> SurfaceMaterial& {
        return appearance.materials.empty() ? ignored : appearance.materials.back();
    };
    for_each_line(file, [&](const std::string& keyword, std::istringstream& rest, int line) {
        if (keyword == "newmtl") {
            index_of_name[name_in(rest)] = int(appearance.materials.size());
            appearance.materials.emplace_back();
        } else if (keyword == "Kd" && !current().texture) {
            Vec3 colour;
            if (rest >> colour[0] >> colour[1] >> colour[2])
                current().colour = colour.cwiseMax(0.0).cwiseMin(1.0);
        } else if (keyword == "map_Kd") {
            Texture texture;
            const std::string name = read_texture(rest, texture);
            texture.image = appearance.add_image_file(file, name, file.string() + ":" + std::to_string(line));
            current().texture = texture;
            current().colour.reset();
        } else if (keyword == "map_d") {
            current().cutoff = kHalf;
        }
    });
}

/// [polygons] material of each, -1: none.
std::vector<int> materials_of_polygons(const std::filesystem::path& file, const ObjMesh& mesh,
                                       Appearance& appearance)
{
    std::map<std::string, int> index_of_name;
    std::map<int, int> material_from{{0, -1}}; // by the line from which on it holds
    for_each_line(file, [&](const std::string& keyword, std::istringstream& rest, int line) {
        if (keyword == "mtllib") {
            const std::string name = name_in(rest);
            const std::filesystem::path library = file.parent_path() / name;
            if (std::error_code error; std::filesystem::is_regular_file(library, error))
                read_materials(library, appearance, index_of_name);
            else
                appearance.left_out.push_back(file.string() + ":" + std::to_string(line) + ": mtllib \"" +
                                              name + "\": no such file beside this one");
        } else if (keyword == "usemtl") {
            const auto known = index_of_name.find(name_in(rest));
            material_from[line] = known != index_of_name.end() ? known->second : -1;
        }
    });
    std::vector<int> materials;
    for (const int line : mesh.polygon_lines)
        materials.push_back(std::prev(material_from.upper_bound(line))->second);
    return materials;
}

Eigen::Vector4d linear_rgba(const Vec3& srgb)
{
    const Vec3 linear = srgb.cwiseMax(0.0).cwiseMin(1.0).unaryExpr(&linear_from_srgb);
    return {linear[0], linear[1], linear[2], 1.0};
}

} // namespace

Appearance import_obj_appearance(const std::filesystem::path& file)
{
    const ObjMesh mesh = read_obj(file);
    Appearance appearance;
    const std::vector<int> materials = materials_of_polygons(file, mesh, appearance);
    appearance.triangles = mesh.triangulated().triangles;
    for (size_t f = 0; f < materials.size(); ++f)
        appearance.material.resize(appearance.material.size() + mesh.triangles_of(int(f)).size(),
                                   materials[f]);

    // v of OBJ points up.
    appearance.coordinates = texture_triangles(mesh);
    for (CornerCoordinates& corners : appearance.coordinates)
        for (Vec2& corner : corners)
            corner.y() = 1.0 - corner.y();
    if (appearance.coordinates.empty())
        for (SurfaceMaterial& material : appearance.materials)
            material.texture.reset();

    if (mesh.colours.empty())
        return appearance;
    std::replace(appearance.material.begin(), appearance.material.end(), -1, appearance.add_white());
    for (size_t t = 0; t < appearance.triangles.size(); ++t) {
        const bool is_textured = appearance.materials[size_t(appearance.material[t])].texture.has_value();
        CornerColours& colours = appearance.colours.emplace_back();
        for (size_t k = 0; k < 3; ++k) {
            const Vec3& own = mesh.colours[size_t(appearance.triangles[t][int(k)])];
            colours[k] = linear_rgba(is_textured ? Vec3(Vec3::Ones()) : own);
        }
    }
    return appearance;
}

} // namespace toile::avatars
