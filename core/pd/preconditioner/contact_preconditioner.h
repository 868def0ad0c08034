#pragma once

namespace toile {

/// Preconditioners of PCG with active contact, compared in docs/journal/nested_pcg.md. The first four are
/// inverses E of D + dH in the same nesting (NestedPcg). The last is for comparison only: it does not
/// converge.
enum class ContactPreconditioner { Block, Exact, ShermanMorrison, Chebyshev, Paper };

} // namespace toile
