#include "export/cache_writer.h"

#include <cmath>
#include <set>
#include <string>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/extension.h"
#include "export/alembic/abc_writer.h"
#include "export/archive/names.h"
#include "export/cache_format.h"
#include "export/cache_path.h"
#include "export/gltf/glb_writer.h"
#include "export/mdd/mdd_writer.h"
#include "export/obj/obj_file.h"
#include "export/pc2/pc2_writer.h"
#include "export/ply/ply_file.h"
#include "export/sequence/mesh_files.h"
#include "export/usd/usd_writer.h"
#include "export/usd/usdc_writer.h"
#include "export/vtk/vtk_writer.h"

namespace toile::exports {

namespace {

using std::filesystem::path;

void require_sane(const path& file, const CacheLayout& layout)
{
    const auto refuse = [&](const std::string& why) { throw InvalidInput(file.string() + ": " + why); };
    if (layout.meshes.empty())
        refuse("the cache has no mesh; give it one");
    for (const CacheMesh& mesh : layout.meshes)
        if (mesh.vertex_count < 1)
            refuse("the cache has no vertex; give it a mesh");
    if (layout.frame_count < 1)
        refuse("frame count is " + std::to_string(layout.frame_count) + "; it must be 1 or more");
    if (!(layout.fps > 0.0) || !std::isfinite(layout.fps))
        refuse("fps is " + std::to_string(layout.fps) + "; it must be positive");
    if (layout.subframes < 1)
        refuse("has " + std::to_string(layout.subframes) + " samples a frame; it must be 1 or more");
    if (!(std::fabs(layout.start_frame) < 1e9))
        refuse("start frame is " + std::to_string(layout.start_frame) + "; it must be a number of frames");
    if (layout.resume_at < 0 || layout.resume_at > layout.frame_count)
        refuse("resuming at frame " + std::to_string(layout.resume_at) + " of " +
               std::to_string(layout.frame_count) + "; frames to keep must be 0 up to that count");
    if (std::filesystem::is_directory(file))
        refuse("is a folder; choose another name for the cache");
    if (is_stream(file))
        refuse("is no regular file; choose another name for the cache");
}

void require_faces(const path& file, const CacheLayout& layout)
{
    for (const CacheMesh& mesh : layout.meshes) {
        if (mesh.faces.polygons.empty())
            throw InvalidInput(file.string() + ": needs faces and the layout has none; use .pc2 or .mdd");
        for (const std::vector<int>& polygon : mesh.faces.polygons)
            for (const int v : polygon)
                if (v < 0 || v >= mesh.vertex_count)
                    throw InvalidInput(file.string() + ": a face uses vertex " + std::to_string(v) +
                                       "; the cache has vertices 0 to " +
                                       std::to_string(mesh.vertex_count - 1));
    }
}

void require_one_mesh(const path& file, const CacheLayout& layout)
{
    if (layout.meshes.size() > 1)
        throw InvalidInput(file.string() + ": holds one mesh, and there are " +
                           std::to_string(layout.meshes.size()) +
                           "; write each to a file, or all to an .abc, .usda or .glb");
}

/// Refuses attributes that the format has no place for, and panels of other faces.
void require_attributes(const path& file, const CacheLayout& layout)
{
    if (layout.has_attributes() && !features_of(cache_format(file)).attributes)
        throw InvalidInput(file.string() +
                           ": stores no attributes; write an .abc, .usda, .usdc, .ply or .pvd");
    for (const CacheMesh& mesh : layout.meshes) {
        std::set<std::string> taken{kPanelAttribute};
        for (const std::string& name : mesh.attributes)
            if (clean_name(name) != name || !taken.insert(name).second)
                throw InvalidInput(file.string() + ": has an attribute \"" + name +
                                   "\"; give each a name of its own, of letters, digits and underscores, and "
                                   "not \"panel\"");
        if (!mesh.panels.of_face.empty() && mesh.panels.of_face.size() != mesh.faces.polygons.size())
            throw InvalidInput(file.string() + ": has panels of " +
                               std::to_string(mesh.panels.of_face.size()) + " faces, and the layout has " +
                               std::to_string(mesh.faces.polygons.size()));
    }
}

void require_numbers(const path& file, const CacheLayout& layout)
{
    if (layout.start_frame < 0.0 || layout.start_frame != std::floor(layout.start_frame))
        throw InvalidInput(file.string() + ": start frame " + std::to_string(layout.start_frame) +
                           " can't number a file; it must be a whole number, 0 or more");
}

void require_max_error(const path& file, const CacheLayout& layout)
{
    if (!(layout.max_error > 0.0) || !std::isfinite(layout.max_error))
        throw InvalidInput(file.string() + ": largest error is " + std::to_string(layout.max_error) +
                           " m; it must be positive");
}

void require_no_placeholder(const path& file)
{
    if (NumberedFiles::has_digits_placeholder(file))
        throw InvalidInput(file.string() + ": is one file, which lists those of the frames; leave out the #");
}

/// One file, or one for each frame.
std::unique_ptr<CacheWriter> mesh_files(const path& file, const CacheLayout& layout,
                                        MeshFileWriter (&writer_for)(const CacheLayout&))
{
    require_faces(file, layout);
    require_numbers(file, layout);
    if (files_of_frames(file, layout.frame_count))
        return std::make_unique<MeshSequenceCache>(file, layout, writer_for(layout));
    return std::make_unique<MeshFileCache>(file, layout, writer_for(layout));
}

void require_whole_archive(const path& file)
{
    if (archive_of(file) != file)
        throw InvalidInput(file.string() + ": names a mesh in an archive; write the archive " +
                           archive_of(file).string());
}

std::unique_ptr<CacheWriter> open_usd_writer(const path& file, const CacheLayout& layout)
{
    require_whole_archive(file);
    require_faces(file, layout);
    const std::string extension = lower_case_extension(file);
    if (extension == ".usda")
        return std::make_unique<UsdWriter>(file, layout, file.stem().string());
    if (extension == ".usdc")
        return std::make_unique<UsdcWriter>(file, layout);
    throw InvalidInput(file.string() + ": may be text or binary; write .usda or .usdc");
}

std::unique_ptr<CacheWriter> open_writer(const path& file, const CacheLayout& layout)
{
    const CacheFormat format = cache_format(file);
    if (!features_of(format).several)
        require_one_mesh(file, layout);
    require_attributes(file, layout);
    if (features_of(format).numbered && layout.subframes > 1)
        throw InvalidInput(file.string() + ": has a file for each frame and none between, and there are " +
                           std::to_string(layout.subframes) + " samples a frame; write an .abc or .usda");
    switch (format) {
    case CacheFormat::Pc2:
        return std::make_unique<Pc2Writer>(file, partial_beside(file), layout);
    case CacheFormat::Mdd:
        return std::make_unique<MddWriter>(file, layout);
    case CacheFormat::Abc:
        require_whole_archive(file);
        require_faces(file, layout);
        return std::make_unique<AbcWriter>(file, layout);
    case CacheFormat::Usd:
        return open_usd_writer(file, layout);
    case CacheFormat::Glb:
        require_faces(file, layout);
        require_max_error(file, layout);
        return std::make_unique<GlbWriter>(file, layout);
    case CacheFormat::Vtk:
        require_faces(file, layout);
        require_numbers(file, layout);
        require_no_placeholder(file);
        return std::make_unique<VtkWriter>(file, layout);
    case CacheFormat::Obj:
        return mesh_files(file, layout, obj_file_writer);
    case CacheFormat::Ply:
        return mesh_files(file, layout, ply_file_writer);
    }
    return nullptr;
}

} // namespace

std::unique_ptr<CacheWriter> make_cache_writer(const path& file, const CacheLayout& layout)
{
    require_sane(file, layout);
    return open_writer(file, layout);
}

} // namespace toile::exports
