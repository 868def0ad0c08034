#pragma once

#include "core/compute/cuda/report.h"
#include "core/compute/cuda/sum_scratch.h"
#include "core/compute/types.h"
#include "garment/energy/membrane_kernels.h"
#include "tests/core/compute/shared_items.h"

namespace toile::test {

using namespace garment;

/// Counts the visits of item i.
struct CountVisits {
    View<int> visits;
    TOILE_HD void operator()(int i) const { ++visits[i]; }
};

/// Counts the visits of the first and the last of many items.
struct CountEndVisits {
    int count;
    View<int> visits; // [2]
    TOILE_HD void operator()(int i) const
    {
        if (i == 0)
            ++visits[0];
        if (i == count - 1)
            ++visits[1];
    }
};

/// sum_i += factor * term_i
struct AddScaled {
    View<const double> term;
    double factor;
    View<double> sum;
    TOILE_HD void operator()(int i) const { sum[i] += factor * term[i]; }
};

/// Multiplies all items by slot[0].
struct ScaleBySlot {
    View<const double> slot; // [1]
    View<double> items;
    TOILE_HD void operator()(int i) const { items[i] *= slot[0]; }
};

/// next_i = last_(n - 1 - i) + older_i; only `older` may be loaded in the prologue.
struct AddLastTwo {
    View<const unsigned> older, last;
    View<unsigned> next;

    TOILE_HD unsigned prologue(int i) const { return older[i]; }
    TOILE_HD void operator()(int i, unsigned local) const { next[i] = last[last.size() - 1 - i] + local; }
};

/// Record of several words.
struct Numbers {
    static constexpr int kCount = 16;
    double of[kCount];
};

/// Reports first, first + 1/4, ...
struct SendNumbers {
    SendReport<Numbers> send;
    double first;
    TOILE_HD void operator()(int) const
    {
        Numbers numbers;
        for (int j = 0; j < Numbers::kCount; ++j)
            numbers.of[j] = first + 0.25 * j;
        send(numbers);
    }
};

/// Waits for the host to change a word of its memory, for some seconds at most.
struct HearFromHost {
    View<int> word;  ///< [1] in host memory
    View<int> heard; ///< [1] out: the word at the end
    TOILE_HD void operator()(int) const
    {
        constexpr int kPolls = 1 << 22;
        const volatile int* const at = &word[0];
        int found = *at;
        for (int poll = 0; poll < kPolls && found == 0; ++poll)
            found = *at;
        heard[0] = found;
    }
};

/// Writes item i to a given address: the test gives an invalid one.
struct WriteWild {
    View<int> nowhere;
    TOILE_HD void operator()(int i) const { nowhere[i] = i; }
};

/// Alignment and size of types that host and device exchange, as seen by the compiler of this code.
struct WriteLayout {
    static constexpr int kNumbers = 16;
    View<int> out; // [kNumbers]
    TOILE_HD void operator()(int) const
    {
        const int numbers[kNumbers] = {EIGEN_MAX_STATIC_ALIGN_BYTES,
                                       alignof(Vec2),
                                       sizeof(Vec2),
                                       alignof(Vec3),
                                       sizeof(Vec3),
                                       alignof(Mat2),
                                       sizeof(Mat2),
                                       alignof(Mat3),
                                       sizeof(Mat3),
                                       alignof(Mat32),
                                       sizeof(Mat32),
                                       alignof(Eigen::Matrix<double, 3, 4>),
                                       sizeof(Eigen::Matrix<double, 3, 4>),
                                       alignof(Eigen::Matrix4d),
                                       sizeof(Eigen::Matrix4d),
                                       sizeof(View<const Mat2>)};
        for (int k = 0; k < kNumbers; ++k)
            out[k] = numbers[k];
    }
};

/// Term w_i p_i of a vector sum.
struct WeightedPoint {
    View<const double> weight;
    View<const Vec3> point;
    TOILE_HD Vec3 operator()(int i) const { return weight[i] * point[i]; }
};

/// Item i as a term.
struct NumberAt {
    View<const double> numbers;
    TOILE_HD double operator()(int i) const { return numbers[i]; }
};

// Launches with default stage names and block sizes.
void launch(const CudaSpace& space, const CountVisits& kernel, int block = 256);
void launch(const CudaSpace& space, const CountEndVisits& kernel);
void launch(const CudaSpace& space, const AddScaled& kernel);
void launch(const CudaSpace& space, const ScaleBySlot& kernel);
void launch(const CudaSpace& space, const AddLastTwo& kernel);
void launch(const CudaSpace& space, const SendNumbers& kernel);
void launch(const CudaSpace& space, const HearFromHost& kernel);
void launch(const CudaSpace& space, const WriteWild& kernel);
void launch(const CudaSpace& space, const WriteLayout& kernel);
void launch(const CudaSpace& space, const ProjectMembraneTriangle<Mat32>& kernel);
void launch(const CudaSpace& space, const GatherCorners& kernel);
void launch(const CudaSpace& space, const AssignGaussSeidelRank<SharedByItem, 2>& kernel);
void launch(const CudaSpace& space, const GaussSeidelState& state, int max_items, const MixShared& kernel);

/// Sum of numbers, in a slot of the device or read back.
void sum_into(const CudaSpace& space, View<const double> numbers, View<double> slot,
              DeviceArray<double>& block_sums);
double sum_of(const CudaSpace& space, View<const double> numbers, SumScratch<double>& scratch);
Vec3 sum_of(const CudaSpace& space, const WeightedPoint& term, SumScratch<Vec3>& scratch);

} // namespace toile::test
