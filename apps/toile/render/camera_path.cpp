#include "apps/toile/render/camera_path.h"

#include <algorithm>
#include <cmath>

namespace toile::app {

namespace {

/// Half width of the window that smooths the camera path [s]. Footsteps take about half a second; a shorter
/// window would make the camera bob with them.
constexpr double kFollowWindow = 0.5;

/// Moving averages over `reach` entries to either side; windows are shorter at the ends.
std::vector<Vec3> smoothed(const std::vector<Vec3>& points, int reach)
{
    std::vector<Vec3> means;
    const int count = int(points.size());
    for (int i = 0; i < count; ++i) {
        const int half = std::min({reach, i, count - 1 - i});
        Vec3 sum = Vec3::Zero();
        for (int k = i - half; k <= i + half; ++k)
            sum += points[size_t(k)];
        means.push_back(sum / (2 * half + 1));
    }
    return means;
}

/// Horizontal positions that the camera follows [shots] [m].
std::vector<Vec3> followed(const std::vector<Shot>& shots, const std::vector<Bounds>& boxes, double fps)
{
    std::vector<Vec3> centers;
    for (const Bounds& box : boxes) {
        const Vec3 center = box.center();
        centers.push_back(Vec3(center.x(), 0.0, center.z()));
    }
    const int spacing = shots.size() > 1 ? std::max(shots[1].frame - shots[0].frame, 1) : 1;
    return smoothed(centers, int(kFollowWindow * fps / spacing));
}

} // namespace

PictureSize size_of_part(const scene::Render& render, const preview::Crop& crop)
{
    const double across = crop.right - crop.left, down = crop.bottom - crop.top;
    const double enlarged = 1.0 / std::max(across, down);
    const auto pixels = [&](double fraction, int whole) {
        return std::max(1, int(std::lround(enlarged * fraction * whole)));
    };
    return {pixels(across, render.width), pixels(down, render.height)};
}

CameraPath::CameraPath(const scene::Render& render, const preview::Crop& crop, const CameraTarget& target,
                       const std::vector<Shot>& shots, const std::vector<Bounds>& boxes, double fps)
{
    const Vec3* const point = std::get_if<Vec3>(&target);
    const std::vector<Vec3> centers =
        point != nullptr ? std::vector<Vec3>(shots.size(), Vec3::Zero()) : followed(shots, boxes, fps);
    Bounds view;
    for (size_t i = 0; i < boxes.size(); ++i) {
        view.extend(boxes[i].lower - centers[i]);
        view.extend(boxes[i].upper - centers[i]);
    }
    const bool goes_around =
        std::any_of(shots.begin(), shots.end(), [](const Shot& shot) { return shot.turn_deg != 0.0; });
    const preview::CameraSettings settings{
        .azimuth_deg = render.azimuth_deg, .elevation_deg = render.elevation_deg, .zoom = render.zoom};
    preview::Camera camera = fit_camera(goes_around ? preview::cylinder_around(view) : preview::corners(view),
                                        settings, double(render.width) / render.height);
    camera.crop = crop;
    const Vec3 pivot = point != nullptr ? *point : view.center();
    if (point != nullptr)
        camera = aimed_at(camera, *point, view.center());
    for (size_t i = 0; i < shots.size(); ++i) {
        cameras_.push_back(shots[i].turn_deg == 0.0 ? camera : turned(camera, shots[i].turn_deg, pivot));
        cameras_.back().origin += centers[i];
    }
}

} // namespace toile::app
