#pragma once

namespace toile {

/// Preconditioners of PCG while contact presses, compared in docs/core/nested_pcg.md. The first four are
/// inverses E of D + dH in the same nesting (NestedPcg); the last is for comparison only: it does not
/// converge.
enum class ContactPreconditioner { Block, Exact, ShermanMorrison, Chebyshev, Paper };

} // namespace toile
