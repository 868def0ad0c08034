#pragma once

#include <vector>

#include "core/linear/block_matrix.h"
#include "core/linear/sparse_matrix.h"

namespace toile {

/// Weights of vertices in the errors of Newton's method. In a mean by mass, a light cloth beside heavy bodies
/// could err by far more than the tolerance. So each component, by elements, counts as much as any other;
/// within it vertices count by mass.
class ComponentWeights {
public:
    /// @param masses             [vertices] [kg], positive
    /// @param blocks, isotropic  whose entries connect vertices, fixed ones too
    ComponentWeights(View<const double> masses, const BlockMatrix& blocks, const SparseMatrix& isotropic);

    /// Takes the vertices that are fixed [vertices].
    void set_fixed(View<const unsigned char> fixed);

    /// [vertices] [kg], in all the mass of the free vertices; 0 where fixed
    View<const double> all() const { return weights_; }

    double mass() const { return mass_; } ///< [kg] of the free vertices

    /// Least mass of a component with free vertices, relative to their mean [-]: 1 if they are equal.
    double lightest() const { return lightest_; }

private:
    std::vector<double> masses_;
    std::vector<int> component_; ///< [vertices]
    int component_count_ = 0;
    std::vector<unsigned char> fixed_;
    std::vector<double> weights_;
    double mass_ = 0.0, lightest_ = 1.0;
};

} // namespace toile
