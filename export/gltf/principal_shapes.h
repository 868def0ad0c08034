#pragma once

#include <functional>
#include <vector>

#include <Eigen/Core>

namespace toile::exports {

/// Frames of a moving surface that are read again and again, rather than kept.
struct FrameSource {
    int frame_count = 0;
    int coordinate_count = 0; ///< three per vertex: x, y, z of the first, and so on

    /// Coordinates [m] of a frame.
    std::function<Eigen::VectorXd(int frame)> read;
};

/// A moving surface as a base and shapes that are added to it by weights:
///
///   x(frame) = base + sum_k weights(frame, k) shapes(k)
///
/// Weights are from 0 to 1: Blender and assimp read negative ones as 0. The base is therefore no frame.
struct ShapeAnimation {
    Eigen::VectorXf base;    ///< [coordinates] [m]
    Eigen::MatrixXf shapes;  ///< [coordinates x shapes] displacements [m]
    Eigen::MatrixXf weights; ///< [frames x shapes] [-]

    Eigen::VectorXf frame(int index) const { return base + shapes * weights.row(index).transpose(); }
};

/// Largest distance [m] of a vertex from its place in the source, over all frames.
double max_error(const ShapeAnimation& animation, const FrameSource& source);

/// Principal components of a surface's displacements from its first frame, by decreasing variance.
///
/// D, the displacements [coordinates x frames], is never in memory. Its range is found by random combinations
/// of the frames and a power iteration, Q = orth(D D^T orth(D R)); the components are those of Q^T D [Halko,
/// Martinsson and Tropp 2011, algorithms 4.3 and 5.1]. Exact where shapes_to_find reaches the number of
/// frames less one. Memory: O(coordinates x shapes + frames x shapes). Deterministic.
class PrincipalShapes {
public:
    /// Reads all frames four times.
    PrincipalShapes(const FrameSource& source, int shapes_to_find);

    /// Number found, at most shapes_to_find.
    int count() const { return int(shapes_.cols()); }

    /// [count + 1] Largest distance [m] of a vertex from its place, with the first k shapes.
    const std::vector<double>& max_errors() const { return max_errors_; }

    /// Smallest number of shapes that keep to a distance [m]; count() + 1 if all do not.
    int shapes_for(double distance) const;

    /// The first shapes, count() at most, in single precision.
    ShapeAnimation animation(int shape_count) const;

private:
    void measure_errors(const FrameSource& source);

    Eigen::VectorXd base_;
    Eigen::MatrixXd shapes_;  ///< [coordinates x shapes] orthonormal
    Eigen::MatrixXd weights_; ///< [frames x shapes] [m]
    std::vector<double> max_errors_;
};

} // namespace toile::exports
