#include "tests/volume/statics.h"

#include <Eigen/CholmodSupport>

#include "core/pd/energy/curvature.h"

namespace toile::test {

namespace {

std::vector<Vec3> as_field(const Eigen::VectorXd& numbers)
{
    std::vector<Vec3> field;
    for (Eigen::Index i = 0; i < numbers.size(); i += 3)
        field.emplace_back(numbers.segment<3>(i));
    return field;
}

} // namespace

Statics::Statics(const std::shared_ptr<Energy>& energy, const std::vector<Vec3>& rest)
    : is_prescribed_(3 * rest.size(), 0), displacement_(Eigen::VectorXd::Zero(3 * Eigen::Index(rest.size()))),
      force_(displacement_)
{
    const int n = int(rest.size());
    Curvature curvature(n, {energy});
    curvature.assemble(rest, Definiteness::Exact);
    Triplets entries;
    for (int row = 0; row < n; ++row)
        for (int k = 0; k < curvature.blocks().columns(row).size(); ++k)
            for (int i = 0; i < 3; ++i)
                for (int j = 0; j < 3; ++j)
                    entries.emplace_back(3 * row + i, 3 * curvature.blocks().columns(row)[k] + j,
                                         curvature.blocks().blocks(row)[k](i, j));
    stiffness_.resize(3 * n, 3 * n);
    stiffness_.setFromTriplets(entries.begin(), entries.end());
}

void Statics::prescribe(int vertex, int axis, double displacement)
{
    is_prescribed_[3 * vertex + axis] = 1;
    displacement_[3 * vertex + axis] = displacement;
}

void Statics::add_force(int vertex, const Vec3& force) { force_.segment<3>(3 * vertex) += force; }

Statics::Solution Statics::solve() const
{
    Eigen::SparseMatrix<double> K = stiffness_;
    Eigen::VectorXd b = force_ - stiffness_ * displacement_;
    for (int column = 0; column < K.outerSize(); ++column)
        for (Eigen::SparseMatrix<double>::InnerIterator entry(K, column); entry; ++entry)
            if (is_prescribed_[entry.row()] || is_prescribed_[entry.col()])
                entry.valueRef() = entry.row() == entry.col() ? 1.0 : 0.0;
    for (Eigen::Index i = 0; i < b.size(); ++i)
        if (is_prescribed_[i])
            b[i] = 0.0;
    const Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>> factor(K);
    const Eigen::VectorXd u = displacement_ + factor.solve(b);
    return {as_field(u), as_field(stiffness_ * u - force_)};
}

} // namespace toile::test
