#include "collision/cloth/rigid_ways.h"

#include "core/mesh/rotation.h"

namespace toile {

RigidWays::RigidWays(const std::vector<int>& rigid)
{
    for (int v = 0; v < int(rigid.size()); ++v) {
        if (rigid[v] >= int(bodies_.size()))
            bodies_.resize(rigid[v] + 1);
        if (rigid[v] >= 0)
            bodies_[rigid[v]].vertices.push_back(v);
        leader_.push_back(rigid[v] < 0 ? -1 : bodies_[rigid[v]].vertices.front());
    }
    bulge_.assign(rigid.size(), 0.0);
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

        // An arc is farthest from its chord half-way.
        const Mat3 half = turned_by(0.5 * body.turn);
        for (const int v : body.vertices)
            bulge_[v] =
                (half * (x[v] - body.middle) + body.middle + 0.5 * body.move - x[v] - 0.5 * way[v]).norm();
    }
}

void RigidWays::go(View<const double> share, View<Vec3> going) const
{
    for (const Body& body : bodies_) {
        const double s = share[body.vertices.front()];
        if (s == 1.0)
            continue;
        const Mat3 turned = turned_by(s * body.turn) - Mat3::Identity();
        for (const int v : body.vertices)
            going[v] = s * body.move + turned * (x_[v] - body.middle);
    }
}

} // namespace toile
