#include "core/quadrature/quadrature_solver.h"

#include <utility>

namespace toile {

QuadratureSolver::QuadratureSolver(std::vector<EmbeddedPoint> points, Settings settings,
                                   std::shared_ptr<TableStore> store, TableListener listener)
    : points_(std::move(points)), settings_(settings), store_(std::move(store)),
      listener_(std::move(listener))
{
}

void QuadratureSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    operator_ = QuadratureOperator(store_->get({H, fixed, points_, settings_}, listener_));
}

} // namespace toile
