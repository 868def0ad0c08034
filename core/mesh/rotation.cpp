#include "core/mesh/rotation.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace toile {

Mat3 turned_by(const Vec3& turn)
{
    const double angle = turn.norm();
    return angle > 0.0 ? Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix() : Mat3(Mat3::Identity());
}

Vec3 turn_of(const Mat3& R)
{
    const Eigen::AngleAxisd turn(R);
    return turn.angle() * turn.axis();
}

Mat3 nearest_rotation(const Mat3& A)
{
    const Eigen::JacobiSVD<Mat3> svd(A, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 U = svd.matrixU();
    if ((U * svd.matrixV().transpose()).determinant() < 0.0)
        U.col(2) = -U.col(2);
    return U * svd.matrixV().transpose();
}

} // namespace toile
