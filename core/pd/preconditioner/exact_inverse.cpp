#include "core/pd/preconditioner/exact_inverse.h"

#include "core/base/stages.h"

namespace toile {

namespace {

/// Lower triangle as numbers, coordinates of a vertex adjacent.
Eigen::SparseMatrix<double> lower_triangle(const BlockMatrix& blocks)
{
    const int size = 3 * blocks.rows();
    Eigen::SparseMatrix<double> A(size, size);
    for (int i = 0; i < blocks.rows(); ++i)
        for (int a = 0; a < 3; ++a) {
            A.startVec(3 * i + a);
            for (int k = 0; k < blocks.columns(i).size(); ++k)
                for (int b = 0; b < 3; ++b)
                    if (const int row = 3 * blocks.columns(i)[k] + b; row >= 3 * i + a)
                        A.insertBack(row, 3 * i + a) = blocks.blocks(i)[k](a, b);
        }
    A.finalize();
    return A;
}

} // namespace

void ExactInverse::update(const FrozenHessian& dH, View<const double> D, View<const unsigned char> fixed)
{
    coupled_ = CoupledPart(free_terms(dH, fixed), D);
    uncoupled_.update(coupled_.blocks, D);
    numbers_.resize(3 * long(coupled_.vertices.size()));
    if (coupled_.vertices.empty())
        return;
    const StageScope stage("pd/contact_factor");
    factor_.compute(lower_triangle(coupled_.matrix));
    TOILE_ASSERT(factor_.info() == Eigen::Success); // D is positive definite, dH positive semi-definite
}

void ExactInverse::apply(View<const Vec3> r, View<Vec3> z) const
{
    uncoupled_.apply(r, z);
    if (coupled_.vertices.empty())
        return;
    const StageScope stage("pd/nested_solve");
    for (size_t i = 0; i < coupled_.vertices.size(); ++i)
        numbers_.segment<3>(3 * long(i)) = r[coupled_.vertices[i]];
    numbers_ = factor_.solve(numbers_);
    for (size_t i = 0; i < coupled_.vertices.size(); ++i)
        z[coupled_.vertices[i]] = numbers_.segment<3>(3 * long(i));
}

} // namespace toile
