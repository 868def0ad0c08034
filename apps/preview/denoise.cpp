#include "apps/preview/denoise.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/compute/parallel.h"

namespace toile::preview {

namespace {

constexpr int kPasses = 4;
/// Cubic B-spline.
constexpr std::array<float, 3> kSpline{3.0f / 8.0f, 1.0f / 4.0f, 1.0f / 16.0f};

/// Difference of colours at which the weight falls to exp(-1/2), over that of noise [-]. More blurs shadows,
/// less keeps noise.
constexpr float kColorReach = 2.0f;
/// Sine of the angle between normals at which it does [-]: 6 degrees.
constexpr float kNormalReach = 0.1f;
/// Distance from the plane of the pixel, over the distance, at which it does [-].
constexpr float kPlaneReach = 0.1f;

/// Difference of the colours of paint [-] at which it does.
constexpr float kPaintReach = 0.02f;

/// Variance [-] that 8-bit colours do not show; it is not worth a pass.
constexpr float kInvisible = 1e-8f;

/// Half side of the square over which variances are averaged [pixels].
constexpr int kVarianceReach = 3;

/// What a pass changes of a pixel.
struct Estimate {
    Eigen::Vector3f color = Eigen::Vector3f::Zero();
    float variance = 0.0f;
};

struct Grid {
    const std::vector<NoisyPixel>& pixels;
    int width, height;

    bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width && y < height; }
    const NoisyPixel& at(int x, int y) const { return pixels[size_t(y) * size_t(width) + size_t(x)]; }
};

/// Means of the variances on the same surface around each pixel, over a row or column of pixels.
struct MeanVariance {
    const Grid& grid;
    int across, down; ///< 1 along the row or column, else 0
    std::vector<Estimate>& after;

    void operator()(int pixel) const
    {
        const int x = pixel % grid.width, y = pixel / grid.width;
        const int surface = grid.at(x, y).surface;
        after[size_t(pixel)] = {grid.at(x, y).color, grid.at(x, y).variance};
        if (surface == NoisyPixel::kNoSurface)
            return;
        float sum = 0.0f;
        int count = 0;
        for (int k = -kVarianceReach; k <= kVarianceReach; ++k) {
            const int u = x + across * k, v = y + down * k;
            if (!grid.contains(u, v) || grid.at(u, v).surface != surface)
                continue;
            sum += grid.at(u, v).variance;
            ++count;
        }
        after[size_t(pixel)].variance = sum / float(count);
    }
};

/// Likeness of a pixel to its neighbour [0, 1].
float likeness(const NoisyPixel& p, const NoisyPixel& q)
{
    const Eigen::Vector3f apart = q.position - p.position;
    const float off_plane = p.normal.dot(apart);
    const float distance = std::max(apart.squaredNorm(), 1e-20f);
    const float color = (q.color - p.color).squaredNorm() /
                        (kColorReach * kColorReach * std::max(p.variance + q.variance, 1e-12f));
    const float normal = (q.normal - p.normal).squaredNorm() / (kNormalReach * kNormalReach);
    const float paint = (q.paint - p.paint).squaredNorm() / (kPaintReach * kPaintReach);
    const float plane = off_plane * off_plane / (kPlaneReach * kPlaneReach * distance);
    return std::exp(-0.5f * (color + normal + paint + plane));
}

/// A pass of the wavelet for one pixel.
struct Smooth {
    const Grid& grid;
    int spacing; ///< of taps [pixels]
    std::vector<Estimate>& after;

    void operator()(int pixel) const
    {
        const int x = pixel % grid.width, y = pixel / grid.width;
        const NoisyPixel& p = grid.at(x, y);
        Estimate& result = after[size_t(pixel)];
        result = {p.color, p.variance};
        if (p.surface == NoisyPixel::kNoSurface || p.variance < kInvisible)
            return;
        float weight = kSpline[0] * kSpline[0], variance = weight * weight * p.variance;
        Eigen::Vector3f color = weight * p.color;
        for (int j = -2; j <= 2; ++j)
            for (int i = -2; i <= 2; ++i) {
                const int u = x + spacing * i, v = y + spacing * j;
                if ((i == 0 && j == 0) || !grid.contains(u, v) || grid.at(u, v).surface != p.surface)
                    continue;
                const NoisyPixel& q = grid.at(u, v);
                const float w = kSpline[size_t(std::abs(i))] * kSpline[size_t(std::abs(j))] * likeness(p, q);
                weight += w;
                color += w * q.color;
                variance += w * w * q.variance;
            }
        result.color = color / weight;
        result.variance = variance / (weight * weight);
    }
};

void replace(std::vector<NoisyPixel>& pixels, const std::vector<Estimate>& by)
{
    parallel_for(kCpu, "denoise/replace", int(pixels.size()), [&](int pixel) {
        pixels[size_t(pixel)].color = by[size_t(pixel)].color;
        pixels[size_t(pixel)].variance = by[size_t(pixel)].variance;
    });
}

} // namespace

void remove_noise(std::vector<NoisyPixel>& pixels, int width, int height)
{
    std::vector<Estimate> after(pixels.size());
    const Grid grid{pixels, width, height};
    for (const int across : {1, 0}) {
        parallel_for(kCpu, "denoise/variance", width * height, MeanVariance{grid, across, 1 - across, after});
        replace(pixels, after);
    }
    for (int pass = 0; pass < kPasses; ++pass) {
        parallel_for(kCpu, "denoise/pass", width * height, Smooth{grid, 1 << pass, after});
        replace(pixels, after);
    }
}

} // namespace toile::preview
