#include "avatars/model/lid_kernels.h"
#include "avatars/model/skinning_kernels.h"

#include <algorithm>
#include <iostream>
#include <random>

#include "tests/core/compute/cuda/kernels.h"
#include "tests/core/compute/cuda/on_device.h"

namespace toile::test {

using namespace avatars;

namespace {

using Affine = Eigen::Matrix<double, 3, 4>;

/// Random vertices that follow one to eight random bones each, after no to three of four blend shapes.
struct SkinProblem {
    std::vector<Vec3> rest;
    std::vector<int> first{0};
    std::vector<Influence> influences;
    std::vector<int> first_offset{0};
    std::vector<ShapeOffset> offsets;
    std::vector<Affine> bones; ///< 60, then the shapes' maps

    explicit SkinProblem(int vertices)
    {
        std::mt19937 random(11);
        std::uniform_real_distribution<double> value(-2.0, 2.0);
        std::uniform_int_distribution<int> bone(0, 59), influence_count(1, 8), offset_count(0, 3);
        bones.resize(60);
        for (Affine& map : bones)
            for (int k = 0; k < 12; ++k)
                map(k) = value(random);
        for (int shape = 0; shape < 4; ++shape)
            bones.push_back(0.1 * value(random) * Affine::Identity());
        for (int v = 0; v < vertices; ++v) {
            rest.emplace_back(value(random), value(random), value(random));
            const int count = influence_count(random);
            for (int k = 0; k < count; ++k)
                influences.push_back({bone(random), 1.0 / count});
            first.push_back(int(influences.size()));
            for (int shape = offset_count(random); shape-- > 0;)
                offsets.push_back({shape, Vec3(value(random), value(random), value(random))});
            first_offset.push_back(int(offsets.size()));
        }
    }

    SkinView skin() const { return {rest, first, influences, first_offset, offsets, 60}; }
};

/// Max distance between corresponding points of two sets [m].
double distance(const std::vector<Vec3>& a, const std::vector<Vec3>& b)
{
    double largest = a.size() == b.size() ? 0.0 : INFINITY;
    for (size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        largest = std::max(largest, (a[i] - b[i]).norm());
    return largest;
}

/// Coordinates are at most 2 * (2 + 3 * 0.4) * 3 + 2; the device may contract other multiply-adds than the
/// host.
constexpr double kTolerance = 22.0 * 1e-15;

using CudaSkinning = OnDevice;

TEST_F(CudaSkinning, PosesVerticesAsOnTheCpu)
{
    const SkinProblem problem(10000);
    std::vector<Vec3> expected(problem.rest.size());
    const SkinVertices on_host{problem.skin(), problem.bones, expected};
    for (int v = 0; v < int(expected.size()); ++v)
        on_host(v);

    DeviceArray<Vec3> rest(space(), "test/rest"), x(space(), "test/x", int(expected.size()));
    DeviceArray<int> first(space(), "test/first"), first_offset(space(), "test/first_offset");
    DeviceArray<ShapeOffset> offsets(space(), "test/offsets");
    DeviceArray<Influence> influences(space(), "test/influences");
    DeviceArray<Affine> bones(space(), "test/bones");
    rest.upload(problem.rest);
    first.upload(problem.first);
    influences.upload(problem.influences);
    first_offset.upload(problem.first_offset);
    offsets.upload(problem.offsets);
    bones.upload(problem.bones);
    launch(space(), SkinVertices{{rest.view(), first.view(), influences.view(), first_offset.view(),
                                  offsets.view(), 60},
                                 bones.view(),
                                 x.view()});
    const double difference = distance(x.downloaded(), expected);
    std::cout << "skinning: largest difference " << difference << " m\n";
    EXPECT_LE(difference, kTolerance);
}

TEST_F(CudaSkinning, PosesLidsAsOnTheCpu)
{
    const SkinProblem problem(1000);
    const std::vector<int> first{0, 3, 10, 1000};
    std::vector<int> rims(1000);
    for (int i = 0; i < 1000; ++i)
        rims[size_t(i)] = i * 7 % 1000;
    std::vector<Vec3> expected(3);
    const PlaceLids on_host{{first, rims}, problem.rest, expected};
    for (int lid = 0; lid < 3; ++lid)
        on_host(lid);

    DeviceArray<Vec3> body(space(), "test/body"), middles(space(), "test/middles", 3);
    DeviceArray<int> first_device(space(), "test/first"), rims_device(space(), "test/rims");
    body.upload(problem.rest);
    first_device.upload(first);
    rims_device.upload(rims);
    launch(space(), PlaceLids{{first_device.view(), rims_device.view()}, body.view(), middles.view()});
    EXPECT_LE(distance(middles.downloaded(), expected), kTolerance);
}

} // namespace
} // namespace toile::test
