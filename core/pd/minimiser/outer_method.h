#pragma once

namespace toile {

/// Methods of the outer loop, compared in docs/journal/projective_dynamics.md.
enum class OuterMethod { Newton, Lbfgs, LocalGlobal, Anderson, NewtonPcg };

} // namespace toile
