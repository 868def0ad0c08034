#include "collision/cloth/rigid_ways.h"

#include "core/mesh/rotation.h"

namespace toile {

RigidWays::RigidWays(const std::vector<int>& rigid, const std::vector<double>& weight)
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

void RigidWays::begin(View<const Vec3> x, View<const Vec3> way)
{
    x_ = x;
    for (Body& body : bodies_) {
        body.middle.setZero();
        body.move.setZero();
        for (const int v : body.vertices) {
            body.middle += x[v] / double(body.vertices.size());
            body.move += way[v] / double(body.vertices.size());
        }
        Mat3 products = Mat3::Zero();
        for (const int v : body.vertices) {
            const Vec3 lever = x[v] - body.middle;
            products += (lever + way[v] - body.move) * lever.transpose();
        }
        body.turn = turn_of(nearest_rotation(products));
    }
}

void RigidWays::go(int body, const Vec3& move, double share, std::vector<Vec3>& motion) const
{
    const Body& b = bodies_[body];
    const Mat3 turned = turned_by(share * b.turn) - Mat3::Identity();
    motion.clear();
    for (const int v : b.vertices)
        motion.emplace_back(move + turned * (x_[v] - b.middle));
}

} // namespace toile
