#include <gtest/gtest.h>

#include "core/pd/cuda/body_kernels.h"
#include "core/pd/cuda/contact_descent_kernels.h"
#include "core/pd/minimiser/lbfgs.h"
#include "tests/core/pd/descent_arrays.h"
#include "tests/core/pd/objectives.h"

/// Descent of a GPU with active contact: its kernels, run on the CPU and compared with the CPU's loop. No GPU
/// is needed.
namespace toile::test {

namespace {

class ContactDescentOnHost {
public:
    ContactDescentOnHost(Objective& objective, std::vector<Vec3> start)
        : objective_(objective), count_(int(start.size())), start_(std::move(start)), arrays_(count_),
          list_of_(count_)
    {
        for (int k = 0; k < int(vertices_.size()); ++k)
            list_of_[vertices_[k]] = k + 1;
        begin_at(start_);
    }

    void fix(int vertex) { arrays_.fixed[vertex] = 1; }

    void take_iterations(int count)
    {
        for (int k = 0; k < count; ++k) {
            find_direction();
            ContactTrialSums trial = measure(1.0);
            for (LineSearch line{value_, trial.slope}; !line.accepts(trial.value);) {
                line.shorten(trial.value);
                each(TryStep{arrays_.fields(), line.step});
                trial = measure(line.step);
            }
            value_ = trial.value;
            take(&trial.products);
        }
    }

    /// Discards its pairs.
    void restart()
    {
        const std::vector<Vec3> here = x();
        begin_at(here);
    }

    const std::vector<Vec3>& x() const { return arrays_.here.x; }
    double value() const { return value_; }
    int pairs() const { return pairs_.count(); }

private:
    template <typename Kernel>
    void each(const Kernel& kernel)
    {
        for (int i = 0; i < count_; ++i)
            kernel(i);
    }

    void begin_at(const std::vector<Vec3>& x)
    {
        pairs_.clear();
        each(BeginAt{x, arrays_.fields()});
        const ContactTrialSums trial = measure(0.0);
        EXPECT_EQ(trial.active_count, 5.0);
        value_ = trial.value;
        take(nullptr);
    }

    ContactTrialSums measure(double step)
    {
        arrays_.energy.assign(count_, 0.0);
        arrays_.energy[0] = objective_.evaluate(arrays_.trial.x, arrays_.trial.gradient);
        ContactTrialSums sums;
        for (int i = 0; i < count_; ++i)
            sums += MeasureContactTrial{arrays_.fields(), contact(), pairs_.pairs(), step}(i);
        return sums;
    }

    /// Terms of two vertices each and without force; only their number matters.
    DeviceActiveSet::Frozen contact() { return {list_of_, vertices_, {{}, active_count_, {}}, {}, {}}; }

    void take(const StepProducts* products)
    {
        const int slot = products != nullptr ? pairs_.add(*products) : -1;
        each(TakePoint{{arrays_.fields(), pairs_.before()}, slot});
    }

    void find_direction()
    {
        objective_.precondition(arrays_.trial.z, arrays_.here.z);
        InverseProducts sums;
        for (int i = 0; i < count_; ++i)
            sums += MeasureInverse{arrays_.fields(), pairs_.pairs()}(i);
        FindCoefficients{pairs_, pairs_.before(), of_s_}(sums);
        each(AfterInverse{{arrays_.fields(), 1.0}, pairs_.pairs(), of_s_});
    }

    Objective& objective_;
    int count_;
    std::vector<Vec3> start_;
    DescentArrays arrays_;
    std::vector<int> vertices_{1, 0}, active_count_{2, 3}, list_of_;
    TwoLoop pairs_;
    std::vector<double> of_s_ = std::vector<double>(kHistory);
    double value_ = 0.0;
};

/// Positions after so many iterations of the CPU's L-BFGS.
std::vector<Vec3> by_lbfgs(Objective& objective, std::vector<Vec3> x, int iterations)
{
    Lbfgs lbfgs(kHistory);
    lbfgs.minimise(objective, x, {0.0, iterations});
    return x;
}

TEST(ContactDescent, TakesTheStepsOfTheTwoLoopRecursion)
{
    // Pairs are stored in single precision: steps differ in the eighth digit first, then more.
    Unsymmetric objective;
    for (const int iterations : {1, 2, 3, 6, 12}) {
        const std::vector<Vec3> start = random_field(100, 3),
                                expected = by_lbfgs(objective, start, iterations);
        ContactDescentOnHost descent(objective, start);
        descent.take_iterations(iterations);
        EXPECT_EQ(descent.pairs(), std::min(iterations, kHistory));
        EXPECT_LT(max_distance(descent.x(), expected), 1e-5) << iterations;
        std::vector<Vec3> gradient(100);
        const double value = objective.evaluate(expected, gradient);
        EXPECT_NEAR(descent.value(), value, 1e-4 * value);
    }
}

TEST(ContactDescent, ShortensStepsThatGoTooFar)
{
    Valley objective;
    const std::vector<Vec3> start{Vec3(-1.2, 1.0, 1.0), Vec3(0.0, 0.0, 0.0), Vec3(1.3, 1.5, 2.0)};
    ContactDescentOnHost descent(objective, start);
    descent.take_iterations(5);
    EXPECT_LT(max_distance(descent.x(), by_lbfgs(objective, start, 5)), 1e-4);
}

TEST(ContactDescent, RestartsFromItsCurrentPoint)
{
    Unsymmetric objective;
    ContactDescentOnHost descent(objective, random_field(100, 3));
    descent.take_iterations(3);
    const double value = descent.value();
    const std::vector<Vec3> x = descent.x();
    descent.restart();
    EXPECT_EQ(descent.x(), x);
    EXPECT_EQ(descent.value(), value);
    descent.take_iterations(2);
    EXPECT_LT(max_distance(descent.x(), by_lbfgs(objective, x, 2)), 1e-5);
}

TEST(ContactDescent, KeepsFixedVerticesUnderAnyForce)
{
    Unsymmetric objective;
    const std::vector<Vec3> start = random_field(100, 6);
    ContactDescentOnHost descent(objective, start);
    descent.fix(7);
    descent.restart();
    descent.take_iterations(4);
    EXPECT_EQ(descent.x()[7], start[7]);
    EXPECT_NE(descent.x()[8], start[8]);
}

} // namespace
} // namespace toile::test
