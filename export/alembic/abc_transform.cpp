#include "export/alembic/abc_transform.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "export/byte_order.h"

namespace toile::exports {

namespace {

using Eigen::Matrix4d;

/// Operations of Alembic's transforms, in the upper half of their byte.
enum Operation { kScale, kTranslate, kRotate, kMatrix, kRotateX, kRotateY, kRotateZ };

int value_count(int operation)
{
    constexpr int kCounts[] = {3, 3, 4, 16, 1, 1, 1};
    return kCounts[operation];
}

double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

/// Matrix of an operation on column vectors.
Matrix4d matrix_of(int operation, const double* values)
{
    const auto rotation = [](double degrees, const Vec3& axis) {
        Matrix4d matrix = Matrix4d::Identity();
        if (axis.norm() > 0.0)
            matrix.topLeftCorner<3, 3>() =
                Eigen::AngleAxisd(radians(degrees), axis.normalized()).toRotationMatrix();
        return matrix;
    };
    Matrix4d matrix = Matrix4d::Identity();
    switch (operation) {
    case kScale:
        matrix.diagonal().head<3>() = Vec3(values[0], values[1], values[2]);
        return matrix;
    case kTranslate:
        matrix.topRightCorner<3, 1>() = Vec3(values[0], values[1], values[2]);
        return matrix;
    case kRotate:
        return rotation(values[3], {values[0], values[1], values[2]});
    case kMatrix: // rows of a matrix on row vectors: columns of that on column vectors
        return Eigen::Map<const Matrix4d>(values);
    default:
        return rotation(values[0], Vec3::Unit(operation - kRotateX));
    }
}

} // namespace

double time_of(const AbcTimes& times, int index)
{
    const int count = std::max(int(times.starts.size()), 1);
    const int cycle = index / count;
    const double start = times.starts.empty() ? 0.0 : times.starts[size_t(index % count)];
    return cycle == 0 ? start : start + cycle * times.cycle;
}

AbcTransform::AbcTransform(const AbcReader& reader, int object) : reader_(reader)
{
    for (int at = object; at >= 0; at = reader.objects()[size_t(at)].parent) {
        const AbcReadObject& level = reader.objects()[size_t(at)];
        const auto operations = reader.find(level.properties, {".xform", ".ops"});
        const auto values = reader.find(level.properties, {".xform", ".vals"});
        if (operations && operations->samples > 0 && values && values->samples > 0) {
            Level& added = levels_.emplace_back();
            added.object = at;
            size_t count = 0;
            for (const char code : reader.sample(*operations, 0)) {
                const int operation = static_cast<unsigned char>(code) >> 4;
                if (operation > kRotateZ)
                    reader.refuse(at, "its transform has the unknown operation " + std::to_string(operation));
                added.operations.push_back(operation);
                count += size_t(value_count(operation));
            }
            added.values = *values;
            added.times = reader.times_of(values->time_sampling);
            if (values->type != int(AbcType::Float64) ||
                reader.sample(*values, 0).size() != sizeof(double) * count)
                reader.refuse(at, "its transform has not " + std::to_string(count) +
                                      " numbers of 8 bytes, as its operations need");
        }
        const auto inherits = reader.find(level.properties, {".xform", ".inherits"});
        if (inherits && inherits->samples > 0 && reader.sample(*inherits, 0) == std::string(1, '\0'))
            break;
    }
}

Matrix4d AbcTransform::matrix(const Level& level, int sample) const
{
    const std::vector<double> values = values_of<double>(reader_.sample(level.values, sample));
    Matrix4d matrix = Matrix4d::Identity();
    size_t first = 0;
    for (const int operation : level.operations) {
        const size_t end = first + size_t(value_count(operation));
        if (end > values.size())
            reader_.refuse(level.object,
                           "sample " + std::to_string(sample) + " of its transform is cut short");
        matrix = matrix * matrix_of(operation, &values[first]);
        first = end;
    }
    return matrix;
}

Matrix4d AbcTransform::matrix_at(const Level& level, double t) const
{
    const int samples = level.values.last_changed > 0 ? level.values.samples : 1;
    int after = 0, end = samples; // the first sample at t or later
    while (after < end) {
        const int middle = after + (end - after) / 2;
        if (time_of(level.times, middle) < t)
            after = middle + 1;
        else
            end = middle;
    }
    if (after == 0 || after == samples)
        return matrix(level, std::min(after, samples - 1));
    const double t0 = time_of(level.times, after - 1), t1 = time_of(level.times, after);
    if (!(t1 > t0))
        return matrix(level, after);
    const double part = (t - t0) / (t1 - t0);
    return (1.0 - part) * matrix(level, after - 1) + part * matrix(level, after);
}

int AbcTransform::sample_count() const
{
    int count = 0;
    for (const Level& level : levels_)
        count = std::max(count, level.values.last_changed > 0 ? level.values.samples : 1);
    return count;
}

AbcTimes AbcTransform::times() const
{
    for (const Level& level : levels_)
        if (level.values.last_changed > 0 && level.values.samples == sample_count())
            return level.times;
    return {};
}

void AbcTransform::apply(double t, View<Vec3> points) const
{
    if (levels_.empty())
        return;
    Matrix4d all = Matrix4d::Identity();
    for (const Level& level : levels_)
        all = matrix_at(level, t) * all;
    const Eigen::Affine3d transform(all);
    for (Vec3& point : points)
        point = transform * point;
}

} // namespace toile::exports
