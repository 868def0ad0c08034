#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "core/compute/types.h"
#include "core/mesh/obj.h"
#include "export/axes.h"

namespace toile::exports {

/// A cache on disk whose frames are read one by one: positions in vertex order.
class PointCache {
public:
    /// Reader of the frames; one implementation per format.
    class Source {
    public:
        virtual ~Source() = default;
        virtual std::vector<Vec3> frame(int index) const = 0;

        int vertex_count = 0;
        int frame_count = 0;
        std::optional<double> fps; ///< [frames/s] empty if the format has no rate or there is a single frame
        std::vector<double> times; ///< [frames] [s] where the format has times without a rate; else empty
        int subframes = 1;         ///< samples per frame
        double start_frame = 0.0;
        std::optional<Axes> axes; ///< of the positions; empty if the format does not say
        ObjMesh mesh;             ///< of a format with faces: the first frame with them
    };

    explicit PointCache(std::unique_ptr<const Source> source) : source_(std::move(source)) {}

    int vertex_count() const { return source_->vertex_count; }
    int frame_count() const { return source_->frame_count; }
    std::optional<double> fps() const { return source_->fps; }
    /// Times of frames that are at irregular ones, as they are stored: fault_of_times() may find some. [s]
    const std::vector<double>& times() const { return source_->times; }
    int subframes() const { return source_->subframes; }
    double start_frame() const { return source_->start_frame; }
    std::optional<Axes> axes() const { return source_->axes; }

    /// Faces, or null: PC2 and MDD have positions only.
    const ObjMesh* mesh() const { return source_->mesh.polygons.empty() ? nullptr : &source_->mesh; }

    /// Positions of frame `index` in [0, frame_count()). Safe to call from several threads.
    /// @throws InvalidInput for an index out of range, an OBJ or PLY that doesn't match the first, or a
    /// broken
    ///         sample of Alembic.
    std::vector<Vec3> frame(int index) const;

    /// The same in metres with Y up; where the format does not say what it holds, it is that.
    std::vector<Vec3> frame_in_metres(int index) const;

private:
    std::shared_ptr<const Source> source_;
};

/// Opens a .pc2, .mdd, .abc (open_abc()), .usda, .usdc or .usd (open_usd()), .obj or .ply, or a sequence of
/// the last two: skirt_####.obj, or skirt.obj if only skirt_0000.obj and so on exist. Sizes are checked here
/// against the header, so frame() finds every byte it needs; samples of Alembic are checked one by one.
/// @throws InvalidInput naming the file, the byte or line, the fault and a remedy.
PointCache read_cache(const std::filesystem::path& file);

/// Paths for read_cache() of all meshes in a file: run.abc#/skirt/skirtShape; the file itself for formats of
/// one mesh, and for a path that names a mesh.
/// @throws InvalidInput as read_cache()
std::vector<std::filesystem::path> meshes_of_cache(const std::filesystem::path& file);

} // namespace toile::exports
