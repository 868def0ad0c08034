#pragma once

#include <vector>

#include "core/pd/cuda/descent_kernels.h"

namespace toile::test {

/// Fields of a descent on a GPU, in host memory. The objective contains inertia, and the tolerance of
/// StepError is inactive.
struct DescentArrays {
    struct Point {
        explicit Point(int n) : x(n), gradient(n), z(n) {}
        std::vector<Vec3> x, gradient, z;
    };

    explicit DescentArrays(int n)
        : here(n), trial(n), energy(n), direction(n), s(kHistory * n, PaddedVec3(0.0F)), y(s), w(s),
          masses(n, 1.0), fixed(n, 0), drive(n, Vec3(0.0, 1e30, 0.0)), descent(1)
    {
    }

    DescentFields fields()
    {
        return {{here.x, here.gradient, here.z},
                {trial.x, trial.gradient, trial.z},
                energy,
                direction,
                s,
                y,
                w,
                masses,
                fixed,
                drive,
                {masses, drive, trial.x, trial.gradient},
                descent};
    }

    Point here, trial;
    std::vector<double> energy;
    std::vector<PaddedVec3> direction, s, y, w;
    std::vector<double> masses;
    std::vector<unsigned char> fixed;
    std::vector<Vec3> drive;
    std::vector<Descent> descent;
};

} // namespace toile::test
