#include "apps/preview/denoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "core/compute/types.h"

namespace toile::test {

using namespace preview;

namespace {

constexpr int kSide = 64;
constexpr float kNoise = 0.05f; ///< standard deviation of each channel

/// Square of kSide pixels of one surface that faces the camera.
/// @param color  in grey, of a column
std::vector<NoisyPixel> wall(const std::function<float(int x)>& color, float noise = kNoise)
{
    std::mt19937 random(7);
    std::normal_distribution<float> normal(0.0f, 1.0f);
    std::vector<NoisyPixel> pixels;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) {
            NoisyPixel pixel;
            for (float& channel : pixel.color)
                channel = color(x) + noise * normal(random);
            pixel.variance = 3.0f * noise * noise;
            pixel.normal = Eigen::Vector3f::UnitZ();
            pixel.position = Eigen::Vector3f(0.01f * float(x), 0.01f * float(y), -3.0f);
            pixel.surface = 0;
            pixels.push_back(pixel);
        }
    return pixels;
}

/// Root mean square error of the columns from `first` on, before `end`.
double error(const std::vector<NoisyPixel>& pixels, const std::function<float(int x)>& color, int first = 0,
             int end = kSide)
{
    double sum = 0.0;
    for (int y = 0; y < kSide; ++y)
        for (int x = first; x < end; ++x)
            sum += (pixels[size_t(y * kSide + x)].color.array() - color(x)).square().sum();
    return std::sqrt(sum / (3.0 * kSide * (end - first)));
}

float grey(int) { return 0.5f; }
float step(int x) { return x < kSide / 2 ? 0.2f : 0.8f; }

TEST(RemoveNoise, AveragesOneSurface)
{
    std::vector<NoisyPixel> pixels = wall(grey);
    EXPECT_NEAR(error(pixels, grey), kNoise, 0.1 * kNoise);
    remove_noise(pixels, kSide, kSide);
    EXPECT_LT(error(pixels, grey), 0.15 * kNoise);
}

TEST(RemoveNoise, KeepsTheBorderOfAShadow)
{
    std::vector<NoisyPixel> pixels = wall(step);
    remove_noise(pixels, kSide, kSide);
    EXPECT_LT(error(pixels, step), 0.2 * kNoise);
    EXPECT_LT(error(pixels, step, kSide / 2 - 1, kSide / 2 + 1), 0.3 * kNoise);
}

/// Differences below the noise are only told by the surfaces.
TEST(RemoveNoise, MixesNoSurfacesNormalsOrDepths)
{
    const auto color = [](int x) { return x < kSide / 2 ? 0.5f : 0.52f; };
    const std::vector<std::function<void(NoisyPixel&)>> changes{
        [](NoisyPixel& pixel) { pixel.surface = 1; }, [](NoisyPixel& pixel) { pixel.paint.x() = 0.2f; },
        [](NoisyPixel& pixel) { pixel.normal = Eigen::Vector3f(0.6f, 0.0f, 0.8f); },
        [](NoisyPixel& pixel) { pixel.position.z() -= 1.0f; }};
    for (size_t k = 0; k < changes.size(); ++k) {
        std::vector<NoisyPixel> pixels = wall(color);
        for (int i = 0; i < kSide * kSide; ++i)
            if (i % kSide >= kSide / 2)
                changes[k](pixels[size_t(i)]);
        remove_noise(pixels, kSide, kSide);
        double left = 0.0, right = 0.0;
        for (int y = 0; y < kSide; ++y) {
            left += pixels[size_t(y * kSide + kSide / 2 - 1)].color.mean() / kSide;
            right += pixels[size_t(y * kSide + kSide / 2)].color.mean() / kSide;
        }
        EXPECT_NEAR(right - left, 0.02, 0.007) << k;
    }
}

TEST(RemoveNoise, ChangesNothingWithoutNoiseOrSurface)
{
    const auto ramp = [](int x) { return 0.01f * float(x); };
    std::vector<NoisyPixel> pixels = wall(ramp, 0.0f);
    remove_noise(pixels, kSide, kSide);
    EXPECT_EQ(error(pixels, ramp), 0.0);

    std::vector<NoisyPixel> mixed = wall(grey);
    for (NoisyPixel& pixel : mixed)
        pixel.surface = NoisyPixel::kNoSurface;
    const std::vector<NoisyPixel> before = mixed;
    remove_noise(mixed, kSide, kSide);
    for (size_t i = 0; i < mixed.size(); ++i)
        EXPECT_EQ(mixed[i].color, before[i].color);
}

} // namespace
} // namespace toile::test
