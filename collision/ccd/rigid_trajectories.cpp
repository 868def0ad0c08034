#include "collision/ccd/rigid_trajectories.h"

#include "core/mesh/rotation.h"

namespace toile::collision {

RigidTrajectories::RigidTrajectories(const std::vector<int>& rigid, const std::vector<double>& weight)
    : bodies_(weight.size())
{
    for (int v = 0; v < int(rigid.size()); ++v) {
        if (rigid[v] >= 0)
            bodies_[rigid[v]].vertices.push_back(v);
        leader_.push_back(rigid[v] < 0 ? -1 : bodies_[rigid[v]].vertices.front());
    }
    for (int body = 0; body < count(); ++body)
        bodies_[body].weight = weight[body];
}

void RigidTrajectories::begin(View<const Vec3> x, View<const Vec3> displacement)
{
    x_ = x;
    for (Body& body : bodies_) {
        body.middle.setZero();
        body.move.setZero();
        for (const int v : body.vertices) {
            body.middle += x[v] / double(body.vertices.size());
            body.move += displacement[v] / double(body.vertices.size());
        }
        Mat3 products = Mat3::Zero();
        for (const int v : body.vertices) {
            const Vec3 lever = x[v] - body.middle;
            products += (lever + displacement[v] - body.move) * lever.transpose();
        }
        body.rotation = rotation_vector_of(nearest_rotation(products));
    }
}

void RigidTrajectories::go(int body, const Vec3& move, double fraction, std::vector<Vec3>& motion) const
{
    const Body& b = bodies_[body];
    const Mat3 rotated = rotation_from_vector(fraction * b.rotation) - Mat3::Identity();
    motion.clear();
    for (const int v : b.vertices)
        motion.emplace_back(move + rotated * (x_[v] - b.middle));
}

} // namespace toile::collision
