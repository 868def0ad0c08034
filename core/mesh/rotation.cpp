#include "core/mesh/rotation.h"

#include <Eigen/Geometry>
#include <Eigen/SVD>

namespace toile {

Mat3 rotation_from_vector(const Vec3& rotation_vector)
{
    const double angle = rotation_vector.norm();
    return angle > 0.0 ? Eigen::AngleAxisd(angle, rotation_vector / angle).toRotationMatrix()
                       : Mat3(Mat3::Identity());
}

Vec3 rotation_vector_of(const Mat3& R)
{
    const Eigen::AngleAxisd angle_axis(R);
    return angle_axis.angle() * angle_axis.axis();
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
