#pragma once

#include <vector>

#include "core/compute/types.h"
#include "export/alembic/abc_reader.h"

namespace toile::exports {

/// Time of a sample [s].
double time_of(const AbcTimes& times, int index);

/// Transforms of an object of an archive and of all above it, which may move.
class AbcTransform {
public:
    /// @param object  in reader.objects(); the reader is borrowed
    /// @throws InvalidInput for an operation that is unknown
    AbcTransform(const AbcReader& reader, int object);

    /// Samples of the transform that has most, and their times.
    int sample_count() const;
    AbcTimes times() const;

    /// Moves points [m] as at time t [s]: linear between samples, held outside of them.
    void apply(double t, View<Vec3> points) const;

private:
    /// One of them.
    struct Level {
        int object;
        std::vector<int> operations;
        AbcReadProperty values;
        AbcTimes times;
    };
    Eigen::Matrix4d matrix(const Level& level, int sample) const;
    Eigen::Matrix4d matrix_at(const Level& level, double t) const;

    const AbcReader& reader_;
    std::vector<Level> levels_; ///< from the object upwards
};

} // namespace toile::exports
