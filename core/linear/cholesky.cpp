#include "core/linear/cholesky.h"

#include <cmath>
#include <new>
#include <stdexcept>
#include <string>

#include <cholmod.h>

#include "core/base/blas_memory.h"
#include "core/base/error.h"
#include "core/base/stages.h"

/// Sets OpenBLAS's threads, if it is the installed BLAS. With many threads its small dense kernels ran 12
/// times slower.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

namespace toile {

/// CHOLMOD's settings and symbolic + numeric factor.
struct Cholesky::Cholmod {
    cholmod_common common{};
    cholmod_factor* factor = nullptr;

    Cholmod()
    {
        if (openblas_set_num_threads != nullptr)
            openblas_set_num_threads(1);
        cholmod_start(&common);
        common.supernodal = CHOLMOD_SUPERNODAL;
        common.nmethods = 1;
        common.method[0].ordering = CHOLMOD_METIS;
        common.postorder = 1;
        common.print = 0;
    }
    ~Cholmod()
    {
        cholmod_free_factor(&factor, &common);
        cholmod_finish(&common);
    }
    Cholmod(const Cholmod&) = delete;
    Cholmod& operator=(const Cholmod&) = delete;
};

namespace {

/// Borrows A's arrays: a symmetric row-major matrix is its own column-major transpose. CHOLMOD reads the
/// lower triangle only.
cholmod_sparse as_cholmod(const SparseMatrix& A)
{
    TOILE_ASSERT(A.isCompressed());
    cholmod_sparse view{};
    view.nrow = view.ncol = size_t(A.rows());
    view.nzmax = size_t(A.nonZeros());
    view.p = const_cast<int*>(A.outerIndexPtr());
    view.i = const_cast<int*>(A.innerIndexPtr());
    view.x = const_cast<double*>(A.valuePtr());
    view.stype = -1;
    view.itype = CHOLMOD_INT;
    view.xtype = CHOLMOD_REAL;
    view.dtype = CHOLMOD_DOUBLE;
    view.sorted = 1;
    view.packed = 1;
    return view;
}

/// Transposes one supernode into rows and replaces the diagonal by its reciprocal.
void copy_block(const double* columns, int width, int height, double* rows)
{
    for (int i = 0; i < height; ++i)
        for (int j = 0; j < width; ++j)
            rows[long(i) * width + j] = j > i ? 0.0 : columns[long(j) * height + i];
    for (int i = 0; i < width; ++i)
        rows[long(i) * width + i] = 1.0 / rows[long(i) * width + i];
}

SupernodalFactor copy_factor(const cholmod_factor& L)
{
    const auto* super = static_cast<const int*>(L.super);
    const auto* first_row = static_cast<const int*>(L.pi);
    const auto* first_value = static_cast<const int*>(L.px);
    const auto* row = static_cast<const int*>(L.s);
    const auto* value = static_cast<const double*>(L.x);
    const auto* permutation = static_cast<const int*>(L.Perm);

    SupernodalFactor copy;
    copy.permutation.assign(permutation, permutation + L.n);
    copy.values.resize(L.xsize);
    copy.supernodes.reserve(L.nsuper);
    for (size_t s = 0; s < L.nsuper; ++s) {
        SupernodalFactor::Supernode node;
        node.first_column = super[s];
        node.width = super[s + 1] - super[s];
        const int height = first_row[s + 1] - first_row[s];
        node.row_count = height - node.width;
        node.first_row = int(copy.rows.size());
        node.first_value = first_value[s];
        copy.rows.insert(copy.rows.end(), row + first_row[s] + node.width, row + first_row[s + 1]);
        copy_block(value + node.first_value, node.width, height, copy.values.data() + node.first_value);
        copy.supernodes.push_back(node);
    }
    copy.plan();
    return copy;
}

/// First column whose diagonal is not a positive number; n if all are positive. LAPACKs differ in whether
/// they let NaN pass.
int first_bad_pivot(const SupernodalFactor& L)
{
    for (const SupernodalFactor::Supernode& node : L.supernodes)
        for (int k = 0; k < node.width; ++k) {
            const double reciprocal = L.values[node.first_value + long(k) * node.width + k];
            if (!(reciprocal > 0.0) || !std::isfinite(reciprocal))
                return node.first_column + k;
        }
    return int(L.permutation.size());
}

} // namespace

Cholesky::Cholesky(const SparseMatrix& A) : cholmod_(std::make_unique<Cholmod>())
{
    const StageScope stage("linear/analyse");
    cholmod_sparse view = as_cholmod(A);
    cholmod_->factor = cholmod_analyze(&view, &cholmod_->common);
    if (cholmod_->common.status == CHOLMOD_OUT_OF_MEMORY)
        throw std::bad_alloc();
    refactor(A);
}

Cholesky::~Cholesky() = default;
Cholesky::Cholesky(Cholesky&&) noexcept = default;
Cholesky& Cholesky::operator=(Cholesky&&) noexcept = default;

void Cholesky::refactor(const SparseMatrix& A)
{
    const StageScope stage("linear/factor");
    cholmod_sparse view = as_cholmod(A);
    require_blas_buffer();
    cholmod_factorize(&view, cholmod_->factor, &cholmod_->common);
    const auto refuse = [&](size_t pivot) {
        const int row = static_cast<const int*>(cholmod_->factor->Perm)[pivot];
        throw InvalidInput("the system matrix is not positive definite (row " + std::to_string(row) +
                           "); masses and stiffnesses must be positive and finite");
    };
    if (cholmod_->common.status == CHOLMOD_NOT_POSDEF)
        refuse(cholmod_->factor->minor);
    if (cholmod_->common.status == CHOLMOD_OUT_OF_MEMORY)
        throw std::bad_alloc();
    if (cholmod_->common.status != CHOLMOD_OK)
        throw std::runtime_error("CHOLMOD could not factor a matrix of " + std::to_string(A.rows()) +
                                 " rows (status " + std::to_string(cholmod_->common.status) + ")");
    const auto factor = std::make_shared<const SupernodalFactor>(copy_factor(*cholmod_->factor));
    if (const int pivot = first_bad_pivot(*factor); pivot < int(factor->permutation.size()))
        refuse(size_t(pivot));
    factor_ = factor;
}

void Cholesky::solve(View<const Vec3> b, View<Vec3> x) const
{
    const StageScope stage("linear/solve");
    factor_->solve(b, x);
}

int Cholesky::size() const { return int(factor_->permutation.size()); }
long Cholesky::factor_entries() const { return long(factor_->values.size()); }

} // namespace toile
