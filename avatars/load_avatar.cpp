#include "avatars/load_avatar.h"

#include <algorithm>
#include <map>

#include <Eigen/Geometry>

#include "avatars/import/assimp_import.h"
#include "avatars/import/gltf_import.h"
#include "avatars/model/skinned_avatar.h"
#include "avatars/model/static_avatar.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "core/mesh/obj.h"

namespace toile::avatars {

namespace {

double metres_per_unit(const AvatarSettings& settings)
{
    static const std::map<std::string, double> kUnits{
        {"m", 1.0}, {"cm", 0.01}, {"mm", 0.001}, {"in", 0.0254}};
    const std::string by_format = is_in_centimetres(settings.file) ? "cm" : "m";
    const auto unit = kUnits.find(settings.unit.empty() ? by_format : settings.unit);
    if (unit == kUnits.end())
        throw InvalidInput(settings.file.string() + ": unknown unit '" + settings.unit +
                           "'; use m, cm, mm or in");
    return unit->second;
}

bool has_no_area(const TriangleMesh& mesh, const Triangle& t)
{
    const Vec3& a = mesh.positions[t[0]];
    return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).isZero(0.0);
}

} // namespace

Affine metres_from_file(const AvatarSettings& settings)
{
    Affine result = Affine::Zero();
    if (settings.up.empty() || settings.up == "y")
        result.leftCols<3>().setIdentity();
    else if (settings.up == "z")
        result.leftCols<3>() << 1, 0, 0, 0, 0, 1, 0, -1, 0; // z to y, y to -z
    else
        throw InvalidInput(settings.file.string() + ": unknown up axis '" + settings.up + "'; use y or z");
    return metres_per_unit(settings) * result;
}

void require_surface(const TriangleMesh& mesh, const std::string& source)
{
    if (mesh.triangles.empty())
        throw InvalidInput(source + ": no triangles; an avatar needs a surface");
    if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(),
                    [&](const Triangle& t) { return has_no_area(mesh, t); }))
        throw InvalidInput(source + ": no triangle has an area; an avatar needs a surface");
}

namespace {

std::unique_ptr<Avatar> read_avatar(const AvatarSettings& settings)
{
    const std::string source = settings.file.string();
    if (!std::filesystem::is_regular_file(settings.file))
        throw InvalidInput(source + ": no such file; give the path of a .gltf, .glb, .fbx or .obj body");
    const Affine to_metres = metres_from_file(settings);
    if (lower_case_extension(settings.file) == ".obj") {
        TriangleMesh mesh = read_obj(settings.file).triangulated();
        require_surface(mesh, source);
        return std::make_unique<StaticAvatar>(source, std::move(mesh), to_metres);
    }
    RiggedModel model =
        is_gltf(settings.file) ? import_gltf(settings.file) : import_rigged_model(settings.file);
    model.metres_from_file = to_metres;
    return std::make_unique<SkinnedAvatar>(source, std::move(model));
}

} // namespace

bool is_in_centimetres(const std::filesystem::path& file) { return lower_case_extension(file) == ".fbx"; }

std::unique_ptr<Avatar> load_avatar(const AvatarSettings& settings)
{
    if (settings.file.empty())
        return make_mannequin(settings.mannequin);
    std::unique_ptr<Avatar> avatar = read_avatar(settings);
    avatar->face_outwards();
    return avatar;
}

} // namespace toile::avatars
