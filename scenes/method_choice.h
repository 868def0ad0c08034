#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/linear/global_solver.h"
#include "core/mesh/triangle_mesh.h"
#include "core/quadrature/table_store.h"
#include "garment/rivals/rival.h"
#include "scenes/format/scene.h"

namespace toile {

/// Where a solver gets quadrature tables from, and who hears of their building.
struct TableSource {
    std::shared_ptr<TableStore> store = TableStore::of_process();
    TableListener listener;
};

/// The global solver that a scene asks for.
/// @param rest    kept by auto, which may need it later
/// @param start   the cloth as placed, its rest shape in space
/// @param tables  used by quadrature and auto; auto builds in the background and shows no progress
/// @throws InvalidInput naming `source` where the method cannot work on this cloth
std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method,
                                                 std::shared_ptr<const RestShape> rest,
                                                 const TriangleMesh& start, const std::string& source,
                                                 const TableSource& tables);

/// Where quadrature sees the vertices of a cloth.
std::vector<Place> places_of(const RestShape& rest);

/// True for methods that replace Body altogether.
bool is_rival(scene::SolverMethod method);

/// @param solver  its method is_rival()
std::unique_ptr<Rival> make_rival(const scene::Solver& solver, std::vector<Vec3> positions, ClothModel cloth);

/// @param place  of the attachment in its file, for the message
/// @throws InvalidInput where the method does not know attachments of this kind
void require_method_holds(scene::SolverMethod method, const scene::Attachment& attachment,
                          const std::string& place);

} // namespace toile
