#pragma once

namespace toile {

/// The methods of the outer loop, compared in docs/core/pd.md.
enum class OuterMethod { Lbfgs, LocalGlobal, Anderson, NewtonPcg };

} // namespace toile
