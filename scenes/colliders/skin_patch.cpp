#include "scenes/colliders/skin_patch.h"

#include <Eigen/SVD>

namespace toile::scenes {

namespace {

constexpr double kRadius = 0.02; ///< [m]

/// Weight of the corners of the triangle itself, however far they are [-].
constexpr double kMinWeight = 0.05;

} // namespace

SkinPatch::SkinPatch(const collision::MeshCollider& mesh, View<const Vec3> normals,
                     const collision::SurfacePoint& at, std::vector<int>& index, std::vector<int>& used)
{
    const View<const Vec3> x = mesh.x_t1();
    const Triangle& corner = mesh.triangles()[at.triangle];
    double total = 0.0;
    for (int v = 0; v < x.size(); ++v) {
        const bool is_corner = (corner.array() == v).any();
        const double near = 1.0 - (x[v] - at.point).squaredNorm() / (kRadius * kRadius);
        if (!is_corner && (near <= 0.0 || normals[v].dot(at.normal) <= 0.0)) // not the other side of a hand
            continue;
        if (index[v] < 0) {
            index[v] = int(used.size());
            used.push_back(v);
        }
        vertex_.push_back(index[v]);
        weight_.push_back(std::max(near * near * (near > 0.0), is_corner ? kMinWeight : 0.0));
        start_.push_back(x[v]);
        total += weight_.back();
    }
    for (size_t i = 0; i < start_.size(); ++i) {
        weight_[i] /= total;
        mean_ += weight_[i] * start_[i];
    }
    for (Vec3& p : start_)
        p -= mean_;
}

/// Rotation by the singular value decomposition [Kabsch 1976]. A flat patch leaves the third axis to the
/// other two.
Vec3 SkinPatch::moved(const Vec3& start, View<const Vec3> positions) const
{
    Vec3 mean = Vec3::Zero();
    for (size_t i = 0; i < start_.size(); ++i)
        mean += weight_[i] * positions[vertex_[i]];
    Mat3 covariance = Mat3::Zero();
    for (size_t i = 0; i < start_.size(); ++i)
        covariance += weight_[i] * (positions[vertex_[i]] - mean) * start_[i].transpose();
    const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Mat3 u = svd.matrixU();
    if ((u * svd.matrixV().transpose()).determinant() < 0.0)
        u.col(2) = -u.col(2);
    return mean + u * svd.matrixV().transpose() * (start - mean_);
}

} // namespace toile::scenes
