#include "export/alembic/abc_transform.h"

#include <cmath>
#include <numbers>
#include <utility>

#include <Eigen/Geometry>

#include "core/time/sample_times.h"
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
            added.times = values->last_changed > 0 ? reader.times_of(*values, at) : std::vector<double>{0.0};
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
    const SamplePlace place = place_in(level.times, t);
    if (place.part == 0.0)
        return matrix(level, place.sample);
    return (1.0 - place.part) * matrix(level, place.sample) + place.part * matrix(level, place.sample + 1);
}

std::vector<double> AbcTransform::times() const
{
    std::vector<double> times;
    for (const Level& level : levels_)
        if (level.times.size() > 1)
            times.insert(times.end(), level.times.begin(), level.times.end());
    return times;
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
