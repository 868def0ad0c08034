#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "apps/preview/renderer.h"
#include "apps/toile/render/camera_path.h"
#include "export/point_cache.h"
#include "scenes/colliders/scene_body.h"
#include "scenes/format/scene.h"
#include "scenes/surfaces/cloth_state.h"
#include "scenes/world/world_options.h"

namespace toile::app {

/// Cloths, solids and avatars over time, ready to be rendered: caches with or without their scene, or a
/// scene's start.
class Film {
public:
    /// The start state of a scene.
    static Film of_scene(const scenes::Scene& scene, const scenes::WorldOptions& options);
    /// Caches of a scene's cloths and solids among its avatars; surfaces without a cache are omitted. Those
    /// of irregular times are resampled at the scene's rate.
    /// @param cloth     cloth of a single cache; empty: from its name
    /// @param unlisted  keys of caches that the scene does not export
    static Film of_caches(const scenes::Scene& scene, const std::vector<std::filesystem::path>& caches,
                          const std::string& cloth, const scene::Export& unlisted = {});
    /// Caches that contain their faces. Those of irregular times are resampled at the rate of the cache
    /// before, the first at that of a scene without fps.
    /// @param axes  of caches that do not say theirs
    /// @throws InvalidInput for a cache without faces.
    static Film of_caches_with_faces(const std::vector<std::filesystem::path>& caches,
                                     const exports::Axes& axes);

    Film(Film&&) = default;
    Film& operator=(Film&&) = default;

    const scenes::Scene& settings() const { return settings_; }
    int frame_count() const { return frame_count_; }
    double fps() const { return settings_.fps; }
    scene::Render& render() { return settings_.render; } ///< size, view and samples; may be changed

    /// Gives the avatars the colours of their files.
    /// @param warn  receives what can't be shown, one line each
    void paint_bodies(const std::function<void(const std::string&)>& warn);

    /// Files that paint_bodies() has read, beside those of the scene.
    std::vector<std::filesystem::path> paint_files() const;

    /// Puts the floor at the lowest point of the avatars in their first pose, if there are any and a floor.
    void put_floor_below_avatars();

    /// Prepares pictures. The view contains the target in all of them.
    /// @throws InvalidInput if the target is a name that nothing has.
    void choose(const std::vector<Shot>& shots, const CameraTarget& target = {},
                const preview::Crop& crop = {});

    PictureSize picture_size() const { return size_of_part(settings_.render, crop_); }

    const std::vector<Shot>& shots() const { return shots_; }
    const preview::Camera& camera(size_t shot) const { return path_.at(shot); }

    /// A cloth of the scene in a frame.
    struct Cloth {
        int index = 0;         ///< in the scene
        std::vector<Vec3> now; ///< [vertices] [m]
    };
    std::vector<Cloth> cloths(int frame) const;
    TriangleMesh skin(int frame);
    TriangleMesh solids(int frame) const;

    /// One of the prepared pictures.
    preview::Image picture(size_t shot);

private:
    Film() = default;

    struct Track {
        std::string name;                          ///< of the cloth, solid or mesh
        std::optional<exports::PointCache> cache;  ///< absent: `start` at all times
        std::filesystem::path file;                ///< of the cache
        exports::Axes axes = {};                   ///< of a cache that does not say its own
        const scenes::ClothState* cloth = nullptr; ///< of surfaces_, with a scene
        std::vector<Vec3> start;                   ///< [vertices] [m]
        preview::RenderMesh mesh;
    };

    void add_surface(int index, std::optional<exports::PointCache> cache, const std::filesystem::path& file);
    void drop_replaced();
    void add_cloth(const std::string& name, const scene::Cloth& settings,
                   const std::vector<Triangle>& triangles, const std::vector<Vec3>& start,
                   std::optional<exports::PointCache> cache, const std::filesystem::path& file);
    std::vector<Vec3> positions(const Track& track, int frame) const;
    bool is_cloth(const Track& track) const;
    bool is_shown(const scenes::SceneBody& body) const;
    void show_bodies(int frame);
    std::vector<std::string> names() const;
    /// @param name  of what is to be seen; empty: everything
    Bounds bounds_of(int frame, const std::string& name);
    preview::RenderScene render_scene(int frame) const;

    scenes::Scene settings_; ///< fps, render; defaults for caches without a scene
    std::vector<scenes::SceneBody> bodies_;
    std::vector<std::shared_ptr<const preview::Paint>> paints_; ///< [bodies] or empty
    std::vector<scenes::ClothState> surfaces_; ///< cloths and then solids of the scene; caches refer to them
    std::vector<Track> tracks_;
    int frame_count_ = 0;
    std::vector<Shot> shots_; ///< prepared
    preview::Crop crop_;
    CameraPath path_; ///< of shots_
    std::optional<preview::Renderer> renderer_;
    int rendered_frame_ = -1; ///< that renderer_ has
};

} // namespace toile::app
