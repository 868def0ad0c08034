#pragma once

#include <memory>

#include "core/linear/global_solver.h"
#include "core/quadrature/table_store.h"
#include "garment/energy/rest_shape.h"
#include "scenes/format/scene.h"

namespace toile {

/// Where quadrature gets its tables, and who hears of them.
struct TableSource {
    std::shared_ptr<TableStore> store = TableStore::of_process();
    TableListener listener;
};

/// The global solver that a scene asks for, for cloth of this rest shape. Auto is the direct one.
/// @param tables  used by quadrature only
std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method, const RestShape& rest,
                                                 const TableSource& tables);

} // namespace toile
