#include "export/gltf/principal_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <random>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>

#include "core/base/assert.h"

namespace toile::exports {

namespace {

using Eigen::MatrixXd, Eigen::MatrixXf;

/// Frames that are in memory at once, and vertices whose errors are measured at once: they fit into a cache.
constexpr int kFramesOfBlock = 32, kVerticesOfBlock = 128;

/// Shapes beyond those that are asked for, which make the last of these exact [Halko et al. 2011, 4.2].
constexpr int kOversampling = 8;

/// Calls work(first frame, displacements [coordinates x frames of the block]) for all frames.
template <typename Work>
void for_blocks(const FrameSource& source, const Eigen::VectorXd& base, const Work& work)
{
    for (int first = 0; first < source.frame_count; first += kFramesOfBlock) {
        MatrixXd block(source.coordinate_count, std::min(kFramesOfBlock, source.frame_count - first));
        for (int k = 0; k < block.cols(); ++k)
            block.col(k) = source.read(first + k) - base;
        work(first, block);
    }
}

/// Rows of R for some frames [frames x samples]: numbers from -1 to 1, the same on all machines; or the
/// identity where there is a sample for each frame but the first, which has no displacement.
MatrixXd combinations(int first_frame, Eigen::Index frames, int samples, bool one_for_each)
{
    if (one_for_each)
        return MatrixXd::NullaryExpr(frames, samples, [&](Eigen::Index row, Eigen::Index column) {
            return first_frame + row == column + 1 ? 1.0 : 0.0;
        });
    std::mt19937_64 random(std::uint64_t(first_frame) + 1);
    return MatrixXd::NullaryExpr(frames, samples, [&] { return double(std::int64_t(random())) * 0x1p-63; });
}

MatrixXd orthonormal(const MatrixXd& columns)
{
    return Eigen::HouseholderQR<MatrixXd>(columns).householderQ() *
           MatrixXd::Identity(columns.rows(), columns.cols());
}

/// Square of the largest distance of each column's vertices from zero, at least what it was.
void raise_to_largest(const MatrixXd& residuals, double& largest)
{
    for (Eigen::Index frame = 0; frame < residuals.cols(); ++frame)
        for (Eigen::Index row = 0; row + 2 < residuals.rows(); row += 3)
            largest = std::max(largest, residuals.col(frame).segment<3>(row).squaredNorm());
}

} // namespace

double max_error(const ShapeAnimation& animation, const FrameSource& source)
{
    const Eigen::VectorXd base = animation.base.cast<double>();
    const MatrixXd shapes = animation.shapes.cast<double>(), weights = animation.weights.cast<double>();
    double largest = 0.0;
    for_blocks(source, base, [&](int first, MatrixXd& block) {
        block.noalias() -= shapes * weights.middleRows(first, block.cols()).transpose();
        raise_to_largest(block, largest);
    });
    return std::sqrt(largest);
}

PrincipalShapes::PrincipalShapes(const FrameSource& source, int shapes_to_find) : base_(source.read(0))
{
    const int rank = std::min(source.coordinate_count, source.frame_count - 1);
    const int samples = std::min(rank, shapes_to_find + kOversampling);
    if (samples == 0) {
        shapes_.resize(source.coordinate_count, 0);
        weights_.resize(source.frame_count, 0);
        measure_errors(source);
        return;
    }

    // Range of the displacements D: random combinations of the frames, then D D^T of them.
    const bool one_for_each = samples == source.frame_count - 1;
    MatrixXd range = MatrixXd::Zero(source.coordinate_count, samples);
    for_blocks(source, base_, [&](int first, const MatrixXd& block) {
        range.noalias() += block * combinations(first, block.cols(), samples, one_for_each);
    });
    MatrixXd Q = orthonormal(range);
    range.setZero();
    for_blocks(source, base_, [&](int, const MatrixXd& block) {
        const MatrixXd coefficients = block.transpose() * Q;
        range.noalias() += block * coefficients;
    });
    Q = orthonormal(range);

    // Principal directions of the coefficients Q^T D, the largest first.
    MatrixXd coefficients(source.frame_count, samples);
    for_blocks(source, base_, [&](int first, const MatrixXd& block) {
        coefficients.middleRows(first, block.cols()).noalias() = block.transpose() * Q;
    });
    const Eigen::SelfAdjointEigenSolver<MatrixXd> eigen(coefficients.transpose() * coefficients);
    const MatrixXd directions =
        eigen.eigenvectors().rowwise().reverse().leftCols(std::min(samples, shapes_to_find));
    shapes_ = Q * directions;
    weights_ = coefficients * directions;
    measure_errors(source);
}

void PrincipalShapes::measure_errors(const FrameSource& source)
{
    max_errors_.assign(size_t(count()) + 1, 0.0); // squares, until the end
    for_blocks(source, base_, [&](int first, MatrixXd& block) {
        constexpr int kRows = 3 * kVerticesOfBlock;
        for (Eigen::Index row = 0; row < block.rows(); row += kRows) {
            const Eigen::Index rows = std::min<Eigen::Index>(kRows, block.rows() - row);
            MatrixXd residuals = block.middleRows(row, rows);
            raise_to_largest(residuals, max_errors_[0]);
            for (int k = 0; k < count(); ++k) {
                residuals.noalias() -= shapes_.col(k).segment(row, rows) *
                                       weights_.col(k).segment(first, block.cols()).transpose();
                raise_to_largest(residuals, max_errors_[size_t(k) + 1]);
            }
        }
    });
    for (double& error : max_errors_)
        error = std::sqrt(error);
}

int PrincipalShapes::shapes_for(double distance) const
{
    const auto enough =
        std::find_if(max_errors_.begin(), max_errors_.end(), [&](double error) { return error <= distance; });
    return int(enough - max_errors_.begin());
}

ShapeAnimation PrincipalShapes::animation(int shape_count) const
{
    TOILE_ASSERT(shape_count >= 0 && shape_count <= count());
    ShapeAnimation animation{
        {}, MatrixXf(shapes_.rows(), shape_count), MatrixXf(weights_.rows(), shape_count)};
    Eigen::VectorXd base = base_;
    for (int k = 0; k < shape_count; ++k) {
        const double least = weights_.col(k).minCoeff(), range = weights_.col(k).maxCoeff() - least;
        const double per_metre = range > 0.0 ? 1.0 / range : 0.0;
        base += least * shapes_.col(k);
        animation.shapes.col(k) = (range * shapes_.col(k)).cast<float>();
        animation.weights.col(k) = (per_metre * (weights_.col(k).array() - least)).cast<float>();
    }
    animation.base = base.cast<float>();
    return animation;
}

} // namespace toile::exports
