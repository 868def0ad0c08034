#include "apps/preview/renderer.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "apps/preview/denoise.h"
#include "apps/preview/path.h"
#include "core/base/error.h"
#include "core/compute/parallel.h"

namespace toile::preview {

namespace {

/// A pixel takes no more samples if its first kProbeSamples, or kProbeFraction of all, differ by less than
/// kProbeAgreement [display-linear]. That is half a step of 8-bit sRGB in light tones. Fewer probes would
/// miss edges that cover an eighth of a pixel, and the rim of shadows where many samples are asked for.
constexpr int kProbeSamples = 8;
constexpr double kProbeFraction = 0.125;
constexpr double kProbeAgreement = 0.004;

void require_sane(const RenderScene& scene, const RenderSettings& settings)
{
    if (settings.width < 1 || settings.height < 1 || settings.samples < 1 || settings.width > 16384 ||
        settings.height > 16384)
        throw InvalidInput("render: " + std::to_string(settings.width) + " x " +
                           std::to_string(settings.height) + " pixels with " +
                           std::to_string(settings.samples) +
                           " samples; pixels must be 1 to 16384 a side, samples 1 or more");
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const RenderMesh& mesh = scene.meshes[m];
        const std::string name = "render: mesh " + std::to_string(m);
        for (const Triangle& t : mesh.triangles)
            if (t.minCoeff() < 0 || t.maxCoeff() >= int(mesh.positions.size()))
                throw InvalidInput(name + " has a triangle out of range of its " +
                                   std::to_string(mesh.positions.size()) + " vertices; check its indices");
        if (mesh.material.print != Print::Plain && mesh.corner_coordinates.size() != mesh.triangles.size())
            throw InvalidInput(name + " has a print but no coordinates for it; give corner_coordinates "
                                      "or make it plain");
    }
}

std::uint8_t srgb(double linear)
{
    const double encoded = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1.0 / 2.4) - 0.055;
    return std::uint8_t(std::lround(255.0 * std::clamp(encoded, 0.0, 1.0)));
}

/// Samples of a pixel with several surfaces, over those of others [-]: their borders are not smoothed.
constexpr int kEdgeSamples = 4;

/// Averages the samples of one pixel; the first ones suffice if they agree (background, open floor).
struct ShadePixel {
    const PathTracer& tracer;
    const Camera& camera;
    int width, height, samples;
    std::vector<NoisyPixel>& pixels;

    void operator()(int pixel) const
    {
        const int x = pixel % width, y = pixel / width;
        const PixelSampler sampler(pixel);
        Vec3 sum = Vec3::Zero(), paint = Vec3::Zero(), first_half = Vec3::Zero(), lowest = Vec3::Ones(),
             highest = Vec3::Zero();
        PathSample first;
        bool is_one_surface = true;
        const int probes = std::max(kProbeSamples, int(kProbeFraction * samples));
        int taken = 0;
        while (taken < (is_one_surface ? samples : kEdgeSamples * samples)) {
            const Vec2 jitter = sampler.point(taken, 0);
            const Vec2 at = camera.picture_coordinates((x + jitter.x()) / width, (y + jitter.y()) / height);
            const PathSample path = tracer.trace(at.x(), at.y(), sampler, taken);
            if (taken == 0)
                first = path;
            else
                is_one_surface = is_one_surface && continues(first, path);
            sum += path.color;
            paint += path.paint;
            lowest = lowest.cwiseMin(path.color);
            highest = highest.cwiseMax(path.color);
            ++taken;
            if (taken == samples / 2)
                first_half = sum;
            if (taken == probes && (highest - lowest).maxCoeff() < kProbeAgreement)
                break;
        }
        NoisyPixel& result = pixels[size_t(pixel)];
        const Vec3 mean = sum / taken;
        result.color = mean.cast<float>();
        if (!is_one_surface || first.surface == PathSample::kBackground)
            return;
        result.surface = first.surface;
        result.normal = first.normal.cast<float>();
        result.paint = (paint / taken).cast<float>();
        result.position = (first.position - camera.origin).cast<float>();
        // Halves of a low-discrepancy sequence are such sequences: their difference is twice the error.
        if (taken == samples && samples > 1)
            result.variance = float((first_half / (samples / 2) - mean).squaredNorm());
    }

    /// True if two paths of a pixel met one surface, and not at two of its folds.
    bool continues(const PathSample& a, const PathSample& b) const
    {
        if (a.surface != b.surface)
            return false;
        const double pixel_size = 2.0 * camera.tan_half_fov * (camera.crop.bottom - camera.crop.top) /
                                  height * (a.position - camera.origin).norm();
        return std::abs(a.normal.dot(b.position - a.position)) < pixel_size;
    }
};

} // namespace

Renderer::Renderer(RenderScene scene, RenderSettings settings) : scene_(std::move(scene)), settings_(settings)
{
    require_sane(scene_, settings_);
    for (const RenderMesh& mesh : scene_.meshes) {
        normals_.push_back(vertex_normals(mesh.positions, mesh.triangles));
        rays_.add(mesh.positions, mesh.triangles);
    }
    rays_.commit();
}

void Renderer::update(int mesh, View<const Vec3> positions)
{
    RenderMesh& moved = scene_.meshes[size_t(mesh)];
    if (positions.size() != int(moved.positions.size()))
        throw InvalidInput("render: mesh " + std::to_string(mesh) + " has " +
                           std::to_string(moved.positions.size()) + " vertices and the frame " +
                           std::to_string(positions.size()) + "; a cache plays only on its own mesh");
    moved.positions.assign(positions.begin(), positions.end());
    normals_[size_t(mesh)] = vertex_normals(moved.positions, moved.triangles);
    rays_.update(mesh, positions);
    rays_.commit();
}

Image Renderer::render(const Camera& camera) const
{
    Image image(settings_.width, settings_.height);
    std::vector<NoisyPixel> pixels(size_t(image.width) * size_t(image.height));
    const PathTracer tracer(scene_, normals_, rays_, camera);
    parallel_for(kCpu, "render/pixels", int(pixels.size()),
                 ShadePixel{tracer, camera, image.width, image.height, settings_.samples, pixels});
    if (settings_.removes_noise)
        remove_noise(pixels, image.width, image.height);
    parallel_for(kCpu, "render/encode", int(pixels.size()), [&](int i) {
        for (int channel = 0; channel < 3; ++channel)
            image.rgb[3 * size_t(i) + size_t(channel)] = srgb(pixels[size_t(i)].color[channel]);
    });
    return image;
}

std::vector<Vec3> Renderer::points() const
{
    std::vector<Vec3> all;
    for (const RenderMesh& mesh : scene_.meshes)
        all.insert(all.end(), mesh.positions.begin(), mesh.positions.end());
    return all;
}

} // namespace toile::preview
