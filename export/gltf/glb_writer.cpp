#include "export/gltf/glb_writer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>
#include <utility>

#include "core/base/atomic_file.h"
#include "core/base/error.h"
#include "core/base/number.h"
#include "export/binary_file.h"
#include "export/gltf/glb_file.h"
#include "export/point_cache.h"

namespace toile::exports {

namespace {

/// Shapes that are looked for, to say how many would be needed where kMaxGlbShapes are too few.
constexpr int kMaxShapesToFind = 256;

/// Fraction of the allowed error that shapes are chosen for; the rest is for their rounding to single
/// precision.
constexpr double kErrorToChoose = 0.99;

std::string millimetres(double metres) { return short_text(1000.0 * metres) + " mm"; }

/// Rounded up to two digits, so that what a message proposes is enough.
double rounded_up(double value)
{
    const double digit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
    return std::ceil(value / digit) * digit;
}

FrameSource in_metres(const PointCache& cache, const Axes& axes)
{
    return {cache.frame_count(), 3 * cache.vertex_count(), [&cache, &axes](int frame) -> Eigen::VectorXd {
                std::vector<Vec3> x = cache.frame(frame);
                change_axes(axes, Axes{}, x);
                return Eigen::Map<const Eigen::VectorXd>(x.front().data(), 3 * Eigen::Index(x.size()));
            }};
}

} // namespace

GlbWriter::GlbWriter(std::filesystem::path file, const CacheLayout& layout)
    : file_(std::move(file)), layout_(layout), converted_(partial_beside(file_)),
      frames_(file_, file_.string() + ".partial.pc2", layout)
{
    for (CacheMesh& mesh : layout_.meshes)
        if (mesh.name.empty())
            mesh.name = file_.stem().string();
}

/// As few shapes as keep to the error; all that the motion has where they do not, for complete() to measure.
ShapeAnimation GlbWriter::shapes_of(const FrameSource& source) const
{
    const double to_keep = kErrorToChoose * layout_.max_error;
    PrincipalShapes shapes(source, kMaxGlbShapes);
    if (shapes.shapes_for(to_keep) > kMaxGlbShapes)
        shapes = PrincipalShapes(source, kMaxShapesToFind);
    const int needed = shapes.shapes_for(to_keep);
    if (needed <= kMaxGlbShapes || shapes.count() <= kMaxGlbShapes)
        return shapes.animation(std::min(needed, shapes.count()));

    const double possible = rounded_up(shapes.max_errors()[kMaxGlbShapes] / kErrorToChoose);
    throw InvalidInput(file_.string() + ": needs " + (needed > shapes.count() ? "more than " : "") +
                       std::to_string(std::min(needed, shapes.count())) + " shapes for " +
                       millimetres(layout_.max_error) + ", at most " + std::to_string(kMaxGlbShapes) +
                       " are written; allow " + millimetres(possible) + " with --max-error " +
                       short_text(possible) + " of toile convert, or write .abc. The frames are kept in " +
                       partial().string());
}

std::filesystem::path GlbWriter::complete()
{
    const PointCache cache = read_cache(frames_.complete());
    const FrameSource source = in_metres(cache, layout_.axes);
    const ShapeAnimation animation = shapes_of(source);
    const double error = max_error(animation, source);
    if (error > layout_.max_error)
        throw InvalidInput(file_.string() + ": single precision holds its positions within " +
                           millimetres(error) + ", which is more than " + millimetres(layout_.max_error) +
                           "; move them closer to the origin, or allow it with --max-error of toile convert. "
                           "The frames are kept in " +
                           partial().string());
    write_atomically(converted_, glb_bytes(file_.string(), layout_, animation, error));
    if (layout_.frame_count > 1)
        note_ = std::to_string(animation.shapes.cols()) +
                (animation.shapes.cols() == 1 ? " shape" : " shapes") + ", largest error " +
                millimetres(error);
    return converted_;
}

void GlbWriter::publish()
{
    move_into_place(converted_, file_);
    std::error_code gone_already;
    std::filesystem::remove(partial(), gone_already);
}

} // namespace toile::exports
