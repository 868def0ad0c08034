#include <algorithm>
#include <iostream>
#include <map>
#include <memory>
#include <set>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "apps/toile/terminal/command_line.h"
#include "apps/toile/terminal/commands.h"
#include "avatars/load_avatar.h"
#include "avatars/model/skinned_avatar.h"
#include "avatars/retarget/motion_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "core/base/number.h"
#include "core/mesh/obj.h"
#include "core/mesh/topology.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/point_cache.h"
#include "export/sequence/numbered_files.h"
#include "export/times/frame_times.h"
#include "scenes/format/cache_files.h"
#include "scenes/format/read_scene.h"
#include "scenes/meshes/cloth_mesh.h"
#include "scenes/surfaces/uv_rest.h"
#include "scenes/world/scene_costs.h"
#include "volume/mesh/msh.h"
#include "volume/mesh/quality.h"
#include "volume/mesh/vtk.h"

namespace toile::app {

namespace {

void print(const std::string& key, const auto& value) { std::cout << key << ": " << value << "\n"; }

void print_extent(const std::string& key, View<const Vec3> points)
{
    const Bounds box = bounds(points);
    for (int axis = 0; axis < 3; ++axis)
        std::cout << (axis == 0 ? key + ": " : ", ") << "xyz"[axis] << " " << box.lower[axis] << " to "
                  << box.upper[axis];
    std::cout << "\n";
}

std::string counted(std::ptrdiff_t count, const char* one, const char* many)
{
    return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string shape_text(const SurfaceTopology& topology)
{
    return counted(topology.pieces, "piece", "pieces") + ", " +
           counted(topology.border_loops, "border loop", "border loops") + ", Euler characteristic " +
           std::to_string(topology.euler_characteristic);
}

void print_topology(const SurfaceTopology& topology)
{
    print("pieces", topology.pieces);
    print("border loops", topology.border_loops);
    print("Euler characteristic", topology.euler_characteristic);
    if (!topology.non_manifold_edges.empty())
        print("edges of three or more triangles", topology.non_manifold_edges.size());
}

/// Names of groups in the order of the file, each once.
void print_groups(const ObjMesh& mesh)
{
    std::vector<std::string> names;
    std::set<std::string> seen;
    for (const ObjGroup& group : mesh.groups)
        if (seen.insert(group.name).second)
            names.push_back(group.name);
    std::string text = std::to_string(names.size());
    constexpr size_t kShown = 20;
    for (size_t i = 0; i < std::min(names.size(), kShown); ++i)
        text += (i == 0 ? " (" : ", ") + names[i];
    print("groups", text + (names.empty() ? "" : names.size() > kShown ? ", ...)" : ")"));
}

/// Rest shape that "rest": "uv" would take from the file.
void print_as_rest_shape(const std::filesystem::path& file)
{
    scene::Cloth cloth;
    cloth.shape = file;
    cloth.rest = scene::RestFrom::Uv;
    try {
        const scenes::UvRest rest = scenes::uv_rest(cloth, scenes::cloth_mesh(cloth).mesh);
        print("as rest shape", scenes::scale_note(rest));
        if (const std::string text = scenes::mismatch_warning(rest); !text.empty())
            print("as rest shape", text);
    } catch (const InvalidInput& error) {
        print("not usable as rest shape", error.what());
    }
}

/// What a scene would make of the file.
/// @param stored  topology of the file as it is
void print_as_cloth(const std::filesystem::path& file, const ObjMesh& obj, const SurfaceTopology& stored)
{
    scene::Cloth cloth;
    cloth.shape = file;
    cloth.sewing.emplace();
    try {
        const scenes::ClothMesh made = scenes::cloth_mesh(cloth);
        for (const std::string& warning : made.warnings)
            print("as cloth", warning);
        const TriangleMesh mesh = made.mesh.triangulated();
        const SurfaceTopology surface = surface_topology(mesh.triangles);
        if (shape_text(surface) != shape_text(stored))
            print("as cloth", shape_text(surface));
        const Topology topology = build_branching_topology(mesh, file.string());
        const auto borders = std::count_if(topology.edges.begin(), topology.edges.end(),
                                           [](const Edge& edge) { return edge.is_border(); });
        print("border edges", std::to_string(borders) + (borders == 0 ? " (closed)" : " (open)"));
        if (!obj.polygon_uvs.empty() || obj.first_plain_line > 0)
            print_as_rest_shape(file);
    } catch (const InvalidInput& error) {
        print("not usable as cloth", error.what());
    }
}

void print_obj(const std::filesystem::path& file)
{
    const ObjMesh obj = read_obj(file);
    const TriangleMesh mesh = obj.triangulated();
    print("vertices", mesh.vertex_count());
    print("polygons", obj.polygons.size());
    print("triangles", mesh.triangle_count());
    print("texture coordinates", obj.polygon_uvs.empty() ? "no" : "yes");
    print_groups(obj);
    print("lines", obj.lines.size());
    const SurfaceTopology topology = surface_topology(mesh.triangles);
    print_topology(topology);
    print_as_cloth(file, obj, topology);
    print_extent("extent", mesh.positions);
}

volume::TetMesh read_tets(const std::filesystem::path& file)
{
    return lower_case_extension(file) == ".msh" ? volume::read_msh_tets(file) : volume::read_vtk_tets(file);
}

void print_tets(const std::filesystem::path& file)
{
    const volume::TetMesh mesh = read_tets(file);
    const volume::MeshQuality quality = volume::quality_of(mesh);
    const TriangleMesh surface = volume::boundary_surface(mesh);
    print("vertices", mesh.vertex_count());
    print("tetrahedra", mesh.tet_count());
    print("tetrahedra inside out",
          std::to_string(mesh.turned) + (mesh.turned > 0 ? " (they are turned when read)" : ""));
    print("smallest dihedral angle", short_text(quality.smallest_dihedral) + " degrees");
    print("mean edge", quality.mean_edge);
    print("volume", quality.volume);
    print("vertices of the surface", surface.vertex_count());
    print("triangles of the surface", surface.triangle_count());
    print_topology(surface_topology(surface.triangles));
    print_extent("extent", surface.positions);
}

/// With the keys of `toile mesh --json`, and more.
void print_tets_as_json(const std::filesystem::path& file)
{
    const volume::TetMesh mesh = read_tets(file);
    const volume::MeshQuality quality = volume::quality_of(mesh);
    const TriangleMesh surface = volume::boundary_surface(mesh);
    const SurfaceTopology topology = surface_topology(surface.triangles);
    const Bounds box = bounds(surface.positions);
    const auto json_of = [](const Vec3& p) { return nlohmann::ordered_json{p.x(), p.y(), p.z()}; };
    std::cout << nlohmann::ordered_json{{"file", file.string()},
                                        {"vertices", mesh.vertex_count()},
                                        {"tetrahedra", mesh.tet_count()},
                                        {"inverted", mesh.turned},
                                        {"smallest_dihedral_deg", quality.smallest_dihedral},
                                        {"mean_edge", quality.mean_edge},
                                        {"volume", quality.volume},
                                        {"surface",
                                         {{"vertices", surface.vertex_count()},
                                          {"triangles", surface.triangle_count()},
                                          {"pieces", topology.pieces},
                                          {"euler_characteristic", topology.euler_characteristic}}},
                                        {"lower", json_of(box.lower)},
                                        {"upper", json_of(box.upper)}}
                     .dump(2)
              << '\n';
}

void print_clip(const std::string& name, double duration)
{
    print("clip", "\"" + name + "\", " + std::to_string(duration) + " s");
}

void print_joints(const avatars::Skeleton& skeleton)
{
    std::string names;
    for (const avatars::Joint& joint : skeleton.joints())
        names += (names.empty() ? "" : ", ") + joint.name;
    print("joints", std::to_string(skeleton.size()) + " (" + names + ")");
}

/// A skeleton and its clips.
void print_motion(const avatars::SkeletalMotion& motion)
{
    print("surface", "none; a motion for avatars[].motion");
    print_joints(motion.skeleton);
    for (const avatars::Clip& clip : motion.clips)
        print_clip(clip.name, clip.duration);
}

void print_motion_file(const std::filesystem::path& file) { print_motion(avatars::read_motion_file(file)); }

void print_avatar(const std::filesystem::path& file)
{
    if (const avatars::SkeletalMotion motion = avatars::read_motion_file(file); !motion.has_surface) {
        print_motion(motion);
        return;
    }
    avatars::AvatarSettings settings;
    settings.file = file;
    const std::unique_ptr<avatars::Avatar> avatar = load_avatar(settings);
    std::vector<Vec3> positions(size_t(avatar->vertex_count()));
    avatar->pose({}, avatars::identity_affine(), positions);
    print("vertices", avatar->vertex_count());
    print("triangles", avatar->triangles().size());
    print_topology(surface_topology(avatar->triangles()));
    if (avatar->turned_count() > 0)
        print("triangles turned", std::to_string(avatar->turned_count()) +
                                      " (they faced into the body or against their neighbours)");
    print_extent("extent in the bind pose [m]", positions);
    for (const avatars::Avatar::ClipName& clip : avatar->clips())
        print_clip(clip.name, clip.duration);
    if (const auto* skinned = dynamic_cast<const avatars::SkinnedAvatar*>(avatar.get()))
        print_joints(skinned->model().skeleton);
}

std::string times_text(const std::vector<double>& times)
{
    const std::string fault = exports::fault_of_times(times);
    return fault.empty()
               ? "irregular, " + short_text(times.front()) + " to " + short_text(times.back()) + " s"
               : "unusable, for " + fault;
}

void print_cache(const std::filesystem::path& file)
{
    const exports::PointCache cache = exports::read_cache(file);
    print("frames", (cache.frame_count() + cache.subframes() - 1) / cache.subframes());
    print("points", cache.vertex_count());
    if (cache.fps())
        print("frames per second", shortest_text(*cache.fps()));
    if (cache.subframes() > 1)
        print("samples",
              std::to_string(cache.frame_count()) + ", " + std::to_string(cache.subframes()) + " per frame");
    if (cache.times().empty())
        print("start frame", cache.start_frame());
    else
        print("times", times_text(cache.times()));
    if (cache.axes())
        print("axes", cache.axes()->unit + ", " + cache.axes()->up + " up");
    if (cache.frame_count() == 0)
        return;
    print_extent("extent of the first frame", cache.frame(0));
    print_extent("extent of the last frame", cache.frame(cache.frame_count() - 1));
}

void print_cache_with_faces(const std::filesystem::path& file)
{
    const exports::PointCache cache = exports::read_cache(file);
    print("polygons", cache.mesh()->polygons.size());
    print("texture coordinates", cache.mesh()->texture_coordinates.size());
    print("groups", cache.mesh()->groups.size());
    print_cache(file);
}

/// Each mesh of an archive, or the one named behind #.
void print_archive(const std::filesystem::path& file)
{
    const std::vector<std::filesystem::path> meshes = exports::meshes_of_cache(file);
    if (meshes.empty())
        print("meshes", 0);
    for (const std::filesystem::path& named : meshes) {
        print("mesh", exports::mesh_path_of(named));
        try {
            print_cache_with_faces(named);
        } catch (const InvalidInput& error) {
            print("refused", error.what());
        }
    }
}

/// Names the cache that a body plays, or of whose first sample a cloth is.
std::string cache_text(const auto& shape)
{
    const auto* file = std::get_if<std::filesystem::path>(&shape);
    return file != nullptr && scene_format::is_cache(*file) ? ", cache " + file->string() : "";
}

void print_scene(const std::filesystem::path& file)
{
    const scenes::Scene scene = scenes::read_scene(file);
    const scenes::SceneCosts costs = scenes::expected_costs(scene, true);
    print("name", scene.name);
    if (!scene.description.empty())
        print("description", scene.description);
    std::cout << "frames: " << scene.frames << " at " << scene.fps << " per second\n";
    for (const scene::Avatar& avatar : scene.avatars)
        print("avatar", avatar.name + cache_text(avatar.shape) +
                            (avatar.clip.empty() ? "" : ", clip " + avatar.clip) +
                            (avatar.motion ? ", motion " + avatar.motion->file.string() : ""));
    for (const scene::Cloth& cloth : scene.cloths)
        print("cloth", cloth.name + cache_text(cloth.shape) + ", " + cloth.fabric);
    for (const scene::Solid& solid : scene.solids)
        print("rigid body", solid.name + ", " + short_text(solid.density) + " kg/m^3");
    for (const scene::SoftBody& body : scene.soft_bodies)
        print("soft body", body.name + (body.file ? ", " + body.file->filename().string() : "") +
                               (body.core ? ", around a core" : "") + ", " + short_text(body.young) +
                               " Pa, " + short_text(body.density) + " kg/m^3");
    print("attachments", scene.attachments.size());
    if (costs.parts == 0)
        return;
    print("simulated vertices", costs.vertex_count());
    print("on a GPU", scenes::table_text(costs) + "; " + scenes::memory_text(costs));
}

/// Whether numbered files of this name exist.
bool is_sequence(const std::filesystem::path& file)
{
    const std::optional<exports::CacheFormat> format = exports::known_cache_format(file);
    return format && exports::features_of(*format).numbered && exports::features_of(*format).read_back &&
           !exports::NumberedFiles(file).existing().empty();
}

int info(const std::filesystem::path& file, bool json)
{
    static const std::map<std::string, void (*)(const std::filesystem::path&)> kPrinters{
        {".obj", print_obj},         {".msh", print_tets},
        {".vtk", print_tets},        {".glb", print_avatar},
        {".gltf", print_avatar},     {".fbx", print_avatar},
        {".bvh", print_motion_file}, {".pc2", print_cache},
        {".mdd", print_cache},       {".abc", print_archive},
        {".usda", print_archive},    {".usdc", print_archive},
        {".usd", print_archive},     {".ply", print_cache_with_faces},
        {".pvd", print_cache},       {".json", print_scene}};
    const std::string extension = lower_case_extension(exports::archive_of(file));
    if (json && extension != ".msh" && extension != ".vtk")
        throw InvalidInput(file.string() + ": --json is for tetrahedra; name a .msh or .vtk");
    if (!std::filesystem::is_regular_file(exports::archive_of(file))) {
        if (is_sequence(file)) {
            print_cache_with_faces(file);
            return kExitOk;
        }
        throw InvalidInput(file.string() + ": can't be found; name a file");
    }
    const auto printer = kPrinters.find(extension);
    if (printer == kPrinters.end())
        throw InvalidInput(
            file.string() +
            ": is of an unknown format; known are .obj, .msh, .vtk, .glb, .gltf, .fbx, .bvh, .pc2, .mdd, " +
            ".abc, .usda, .usdc, .usd, .ply and .json (scene)");
    json ? print_tets_as_json(file) : printer->second(file);
    return kExitOk;
}

} // namespace

Command add_info(CLI::App& parser)
{
    Command command;
    command.options =
        parser.add_subcommand("info", "Describe the contents of a mesh, avatar, cache or scene");
    struct Options {
        std::filesystem::path file;
        bool json = false;
    };
    auto options = std::make_shared<Options>();
    command.options->add_option("file", options->file, "File")->required();
    command.options->add_flag("--json", options->json, "Print tetrahedra (.msh, .vtk) as JSON");
    command.run = [options] { return info(options->file, options->json); };
    return command;
}

} // namespace toile::app
