#pragma once

#include "scenes/format/scene.h"

namespace toile::scene {

/// True for the literature's methods, which are there to be compared with.
bool is_baseline(SolverMethod method);

/// True for methods that a GPU has kernels for.
bool runs_on_gpu(SolverMethod method);

/// True for baselines that replace the minimisation of projective dynamics altogether.
bool replaces_minimiser(SolverMethod method);

} // namespace toile::scene
