#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "core/compute/cuda/array.h"
#include "core/pd/cuda/energy.h"
#include "core/pd/energy/energy.h"

/// Energies of a body on a GPU compared with the CPU.
namespace toile::test {

/// Value and gradient.
struct Pull {
    double energy = 0.0;
    std::vector<Vec3> gradient;
};

inline Pull pull_of(Energy& energy, View<const Vec3> x)
{
    Pull pull;
    pull.gradient.assign(x.size(), Vec3::Zero());
    pull.energy = energy.add_gradient(x, pull.gradient);
    return pull;
}

inline double largest_of(const std::vector<Vec3>& field)
{
    double largest = 0.0;
    for (const Vec3& value : field)
        largest = std::max(largest, value.norm());
    return largest;
}

/// @param rounding  relative to the value and to the largest gradient
inline void expect_equal(const Pull& on_gpu, const Pull& on_cpu, double rounding)
{
    EXPECT_NEAR(on_gpu.energy, on_cpu.energy, rounding * std::abs(on_cpu.energy));
    const double scale = largest_of(on_cpu.gradient);
    for (size_t v = 0; v < on_cpu.gradient.size(); ++v)
        EXPECT_LE((on_gpu.gradient[v] - on_cpu.gradient[v]).norm(), rounding * scale) << v;
}

/// Energies of a body on the device, and the inputs of an evaluation.
class EnergiesOnGpu {
public:
    EnergiesOnGpu(const CudaSpace& space, int vertex_count)
        : energies(space), x_(space, "test/x"), gradient_(space, "test/gradient", vertex_count),
          energy_(space, "test/energy", vertex_count), partials_(space, "test/own")
    {
    }

    void begin_step(const std::vector<Vec3>& x, double dt)
    {
        x_.upload(x);
        for (const auto& energy : energies.all())
            energy->begin_step(x_.view(), dt);
    }
    Pull pull(const std::vector<Vec3>& x)
    {
        place(x);
        energies.add_gradient(at());
        return pulled();
    }
    void end_minimisation(const std::vector<Vec3>& x)
    {
        x_.upload(x);
        for (const auto& energy : energies.all())
            energy->end_minimisation(x_.view());
    }

    /// The three parts of pull(), of which the second can be recorded.
    void place(const std::vector<Vec3>& x)
    {
        x_.upload(x);
        gradient_.fill_zero();
        energy_.fill_zero();
        partials_.resize(energies.partial_count());
    }
    DeviceEvaluation at() { return {x_.view(), gradient_.view(), energy_.view(), partials_.view()}; }
    Pull pulled() const
    {
        Pull pull;
        pull.gradient = gradient_.downloaded();
        for (const double part : energy_.downloaded())
            pull.energy += part;
        for (const double part : partials_.downloaded())
            pull.energy += part;
        return pull;
    }

    DeviceEnergies energies;

private:
    DeviceArray<Vec3> x_, gradient_;
    DeviceArray<double> energy_, partials_;
};

} // namespace toile::test
