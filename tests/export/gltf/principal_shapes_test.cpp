#include "export/gltf/principal_shapes.h"

#include <random>

#include <Eigen/SVD>
#include <gtest/gtest.h>

namespace toile::test {

using namespace exports;

namespace {

using Eigen::MatrixXd;

/// Frames in the columns of a matrix.
FrameSource source_of(const MatrixXd& frames)
{
    return {int(frames.cols()), int(frames.rows()),
            [&frames](int frame) -> Eigen::VectorXd { return frames.col(frame); }};
}

MatrixXd random_matrix(int rows, int columns)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    return MatrixXd::NullaryExpr(rows, columns, [&] { return number(random); });
}

/// A base that moves by shapes whose sizes fall like 1 / 4^k.
MatrixXd moving_by_shapes(int coordinates, int frames, int shapes)
{
    MatrixXd displacements = MatrixXd::Zero(coordinates, frames);
    const MatrixXd directions = random_matrix(coordinates, shapes), weights = random_matrix(shapes, frames);
    for (int k = 0; k < shapes; ++k)
        displacements += std::pow(0.25, k) * directions.col(k) * weights.row(k);
    return displacements.colwise() + random_matrix(coordinates, 1).col(0);
}

/// Largest distance of a vertex.
double largest(const MatrixXd& residuals)
{
    double distance = 0.0;
    for (int frame = 0; frame < residuals.cols(); ++frame)
        for (int row = 0; row < residuals.rows(); row += 3)
            distance = std::max(distance, residuals.col(frame).segment<3>(row).norm());
    return distance;
}

TEST(PrincipalShapes, FindsAsManyShapesAsTheMotionHas)
{
    const MatrixXd frames = moving_by_shapes(300, 200, 5);
    const PrincipalShapes shapes(source_of(frames), 64);
    EXPECT_EQ(shapes.count(), 64);
    EXPECT_EQ(shapes.shapes_for(1e-9), 5);
    EXPECT_GT(shapes.max_errors()[4], 1e-4);
}

/// The oracle keeps all frames: singular vectors of the displacements.
TEST(PrincipalShapes, EqualsTheSingularValueDecomposition)
{
    const MatrixXd frames = moving_by_shapes(150, 120, 12);
    const PrincipalShapes shapes(source_of(frames), 10);
    const MatrixXd displacements = frames.colwise() - frames.col(0);
    const Eigen::JacobiSVD<MatrixXd> svd(displacements, Eigen::ComputeThinU);
    for (int k = 0; k <= 10; ++k) {
        const MatrixXd U = svd.matrixU().leftCols(k);
        const double expected = largest(displacements - U * (U.transpose() * displacements));
        EXPECT_NEAR(shapes.max_errors()[size_t(k)], expected, 1e-3 * expected) << k;
    }
}

TEST(PrincipalShapes, MeasuresTheErrorOfWhatIsStored)
{
    const MatrixXd frames = moving_by_shapes(150, 70, 12);
    const PrincipalShapes shapes(source_of(frames), 10);
    const ShapeAnimation animation = shapes.animation(4);
    const MatrixXd played =
        (animation.shapes.cast<double>() * animation.weights.cast<double>().transpose()).colwise() +
        animation.base.cast<double>();
    EXPECT_NEAR(max_error(animation, source_of(frames)), largest(frames - played), 1e-12);
    EXPECT_NEAR(max_error(animation, source_of(frames)), shapes.max_errors()[4], 1e-6);
}

TEST(PrincipalShapes, HasWeightsFromZeroToOne)
{
    const MatrixXd frames = moving_by_shapes(150, 70, 6);
    const ShapeAnimation animation = PrincipalShapes(source_of(frames), 10).animation(6);
    for (int k = 0; k < 6; ++k) {
        EXPECT_EQ(animation.weights.col(k).minCoeff(), 0.0f);
        EXPECT_EQ(animation.weights.col(k).maxCoeff(), 1.0f);
    }
    EXPECT_LT((animation.frame(0).cast<double>() - frames.col(0)).norm(), 1e-5);
}

TEST(PrincipalShapes, IsExactForFewFramesAndForNoMotion)
{
    for (const int count : {2, 3, 9}) {
        const MatrixXd frames = random_matrix(60, count);
        const PrincipalShapes shapes(source_of(frames), 64);
        EXPECT_EQ(shapes.count(), count - 1);
        EXPECT_EQ(shapes.shapes_for(1e-9), count - 1);
    }
    const MatrixXd still = random_matrix(60, 1).replicate(1, 40), single = random_matrix(60, 1);
    EXPECT_EQ(PrincipalShapes(source_of(still), 64).shapes_for(1e-9), 0);
    EXPECT_EQ(PrincipalShapes(source_of(single), 64).shapes_for(1e-9), 0);
}

TEST(PrincipalShapes, SaysThatNoNumberOfThemIsEnough)
{
    const MatrixXd noise = random_matrix(900, 300);
    const PrincipalShapes shapes(source_of(noise), 20);
    EXPECT_EQ(shapes.shapes_for(1e-3), 21);
}

} // namespace
} // namespace toile::test
