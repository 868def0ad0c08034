#include "core/quadrature/device_quadrature_solver.h"

#include <algorithm>
#include <utility>

namespace toile {

namespace {

/// Bodies with the same tables.
struct Equals {
    std::shared_ptr<const QuadratureTables> tables;
    int node_count = 0;
    std::vector<int> first;
};

} // namespace

DeviceQuadratureSolver::DeviceQuadratureSolver(const CudaSpace& space, std::vector<Part> parts,
                                               QuadratureTables::Settings settings,
                                               std::shared_ptr<TableStore> store)
    : space_(space), parts_(std::move(parts)), settings_(settings), store_(std::move(store)),
      b_(space, "quadrature/b"), x_(space, "quadrature/x")
{
}

void DeviceQuadratureSolver::update(const SparseMatrix& H, View<const unsigned char> fixed)
{
    std::vector<Equals> equals;
    int first = 0;
    for (const Part& part : parts_) {
        const int size = int(part.places.size());
        const SparseMatrix block = diagonal_block(H, first, size);
        const auto tables =
            store_->get({block, fixed.subview(first, size), part.places, settings_}, part.listener);
        auto known = std::find_if(equals.begin(), equals.end(),
                                  [&](const Equals& other) { return other.tables == tables; });
        if (known == equals.end())
            known = equals.insert(equals.end(), {tables, size, {}});
        known->first.push_back(first);
        first += size;
    }
    groups_.clear();
    for (const Equals& bodies : equals)
        groups_.push_back(
            std::make_unique<DeviceQuadrature>(space_, *bodies.tables, bodies.node_count, bodies.first));
}

void DeviceQuadratureSolver::solve_there(View<const Vec3> b, View<Vec3> x)
{
    for (const auto& group : groups_)
        group->solve(b, x);
}

void DeviceQuadratureSolver::solve(View<const Vec3> b, View<Vec3> x) const
{
    b_.upload(b);
    x_.resize(x.size());
    for (const auto& group : groups_)
        group->solve(b_.view(), x_.view());
    x_.download(x);
    space_.synchronise();
}

} // namespace toile
