#pragma once

#include "core/pd/minimiser/outer_loop.h"

namespace toile {

/// Plain Projective Dynamics [Bouaziz et al. 2014, alg. 1]: x <- x - H^-1 g, the global step after one local
/// step. If H bounds the Hessian every step of length one descends; the line search ensures descent with
/// energies that omit parts of H. Convergence is linear, and slow in the soft modes out of the cloth's plane:
/// a small displacement does not prove that the minimum is near.
class LocalGlobal : public OuterLoop {
protected:
    void begin(int) override {}
    void find_direction(Objective& objective, const Here& here, View<Vec3> direction) override;
};

} // namespace toile
