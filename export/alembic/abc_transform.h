#pragma once

#include <vector>

#include "core/compute/types.h"
#include "export/alembic/abc_reader.h"

namespace toile::exports {

/// Transforms of an object of an archive and of all above it, which may move.
class AbcTransform {
public:
    /// @param object  in reader.objects(); the reader is borrowed
    /// @throws InvalidInput for an operation that is unknown, and times that do not increase
    AbcTransform(const AbcReader& reader, int object);

    /// Times of the samples of all that move [s]. In no order.
    std::vector<double> times() const;

    /// Moves points [m] as at time t [s]. Each number of a matrix is linear between the samples of that
    /// matrix, and held outside of them.
    void apply(double t, View<Vec3> points) const;

private:
    /// One of them.
    struct Level {
        int object;
        std::vector<int> operations;
        AbcReadProperty values;
        std::vector<double> times; ///< [samples] [s]; one for a transform that does not move
    };
    Eigen::Matrix4d matrix(const Level& level, int sample) const;
    Eigen::Matrix4d matrix_at(const Level& level, double t) const;

    const AbcReader& reader_;
    std::vector<Level> levels_; ///< from the object upwards
};

} // namespace toile::exports
