#pragma once

#include <memory>

#include "core/linear/global_solver.h"
#include "garment/energy/rest_shape.h"
#include "scenes/format/scene.h"

namespace toile {

/// The global solver that a scene asks for, for cloth of this rest shape. Auto is the direct one.
std::unique_ptr<GlobalSolver> make_global_solver(scene::SolverMethod method, const RestShape& rest);

} // namespace toile
