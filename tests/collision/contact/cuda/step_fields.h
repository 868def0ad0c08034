#pragma once

/// Fields of cloth in a step, on the host and on a device, for tests that compare both.

#include <algorithm>
#include <vector>

#include "core/compute/cuda/mirrored_array.h"
#include "core/pd/energy/active_set_energy.h"

namespace toile::test {

inline constexpr double kDt = 1.0 / 120.0; // [s]

/// Fields of the cloths' vertices in a step.
struct Fields {
    std::vector<Vec3> x, prediction, found; ///< at t0, predicted, and at the end of the step [m]
    std::vector<double> diagonal, masses;
    std::vector<unsigned char> fixed;

    void add_tables()
    {
        for (int v = 0; v < int(x.size()); ++v) {
            fixed.push_back(v % 11 == 0);
            diagonal.push_back(100.0 + v % 13);
            masses.push_back(1e-4 * (1.0 + v % 3));
        }
    }
};

/// Positions of a step on the device.
struct OnBoard {
    OnBoard(const CudaSpace& space, int count)
        : x(space, "test/x", count), prediction(space, "test/prediction", count),
          found(space, "test/found", count), v(space, "test/v", count), diagonal(space, "test/diagonal"),
          masses(space, "test/masses"), fixed(space, "test/fixed")
    {
    }
    static void fill(MirroredArray<Vec3>& field, View<const Vec3> values)
    {
        std::copy(values.begin(), values.end(), field.overwrite_on_host().begin());
    }
    StepStart begin(const Fields& made)
    {
        fill(x, made.x);
        fill(prediction, made.prediction);
        fill(found, made.found);
        StepStart start{made.x, made.prediction, made.diagonal, made.fixed, made.masses, kDt};
        diagonal.upload(made.diagonal);
        fixed.upload(made.fixed);
        masses.upload(made.masses);
        start.device = {x.device(), prediction.device(), diagonal.view(), fixed.view(), masses.view()};
        return start;
    }
    MirroredArray<Vec3> x, prediction, found, v;
    DeviceArray<double> diagonal, masses;
    DeviceArray<unsigned char> fixed;
};

} // namespace toile::test
