#pragma once

#include "core/pd/outer_loop.h"

namespace toile {

/// Plain Projective Dynamics [Bouaziz et al. 2014, alg. 1]: x <- x - H^-1 g, the global step after one local
/// step. Where H bounds the Hessian every step of one descends; the line search answers for the energies
/// that leave their share out of H. Linear convergence, slow in the soft modes out of the cloth's plane: a
/// small move does not tell that the minimum is near.
class LocalGlobal : public OuterLoop {
protected:
    void begin(int) override {}
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
};

} // namespace toile
