#include "research/benchmarks/solvers/ball_penalty.h"

#include "core/compute/parallel.h"

namespace toile::research::solvers {

namespace {

/// f of a depth d > 0 and its derivatives.
struct Pressure {
    double f, df, ddf;

    Pressure(double d, double s)
    {
        if (d < s) {
            f = d * d * d / (6.0 * s);
            df = d * d / (2.0 * s);
            ddf = d / s;
        } else {
            f = 0.5 * d * d - 0.5 * s * d + s * s / 6.0;
            df = d - 0.5 * s;
            ddf = 1.0;
        }
    }
};

} // namespace

BallPenalty::BallPenalty(const Ball& ball, std::vector<double> areas) : ball_(ball), areas_(std::move(areas))
{
}

double BallPenalty::add_gradient(View<const Vec3> x, View<Vec3> gradient)
{
    return parallel_sum(kCpu, x.size(), 0.0, [&](int v) {
        const Vec3 from = x[v] - ball_.center;
        const double distance = from.norm();
        if (distance >= ball_.radius || distance == 0.0)
            return 0.0;
        const Pressure p(ball_.radius - distance, ball_.softness);
        const double weight = ball_.stiffness * areas_[v];
        gradient[v] -= weight * p.df / distance * from;
        return weight * p.f;
    });
}

/// Adds f'' n n^T - f' / |x - center| (I - n n^T); the second part is negative.
void BallPenalty::add_curvature(View<const Vec3> x, Definiteness definiteness, BlockWindow K)
{
    parallel_for(kCpu, "benchmarks/ball_curvature", x.size(), [&](int v) {
        const Vec3 from = x[v] - ball_.center;
        const double distance = from.norm();
        if (distance >= ball_.radius || distance == 0.0)
            return;
        const Pressure p(ball_.radius - distance, ball_.softness);
        const Vec3 n = from / distance;
        const Mat3 along = n * n.transpose();
        Mat3 block = p.ddf * along;
        if (definiteness == Definiteness::Exact)
            block -= p.df / distance * (Mat3::Identity() - along);
        K.block(v, v) += ball_.stiffness * areas_[v] * block;
    });
}

} // namespace toile::research::solvers
