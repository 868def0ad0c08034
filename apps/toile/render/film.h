#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/preview/camera.h"
#include "apps/preview/renderer.h"
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
    /// Caches of a scene's cloths and solids among its avatars; surfaces without a cache are omitted.
    /// @param cloth  cloth of a single cache; empty: from its name
    static Film of_caches(const scenes::Scene& scene, const std::vector<std::filesystem::path>& caches,
                          const std::string& cloth);
    /// OBJ caches, which contain their faces.
    /// @throws InvalidInput for a cache without faces.
    static Film of_obj_caches(const std::vector<std::filesystem::path>& caches);

    int frame_count() const { return frame_count_; }
    double fps() const { return settings_.fps; }
    scene::Render& render() { return settings_.render; } ///< size, view and samples; may be changed

    /// Puts the floor at the lowest point of the avatars in their first pose, if there are any and a floor.
    void put_floor_below_avatars();

    /// Prepares pictures of these frames. The view contains all of them and follows a walking avatar.
    void choose(const std::vector<int>& frames);

    /// Picture of one of the prepared frames.
    preview::Image picture(int frame);

private:
    struct Track {
        std::optional<exports::PointCache> cache; ///< absent: `start` at all times
        std::filesystem::path file;               ///< of the cache
        std::optional<scenes::ClothState> cloth;  ///< with a scene
        std::vector<Vec3> start;                  ///< [vertices] [m]
        preview::RenderMesh mesh;
    };

    void add_surface(int index, const scenes::ClothState& state, std::optional<exports::PointCache> cache,
                     const std::filesystem::path& file);
    void add_cloth(const scene::Cloth& settings, const std::vector<Triangle>& triangles,
                   const std::vector<Vec3>& start, std::optional<exports::PointCache> cache,
                   const std::filesystem::path& file);
    std::vector<Vec3> positions(const Track& track, int frame) const;
    bool is_shown(const scenes::SceneBody& body) const;
    void show_bodies(int frame);
    Bounds bounds_of(int frame);
    preview::RenderScene render_scene(int frame) const;

    scenes::Scene settings_; ///< fps, render; defaults for caches without a scene
    std::vector<scenes::SceneBody> bodies_;
    std::vector<Track> tracks_;
    int frame_count_ = 0;
    std::vector<int> frames_;   ///< prepared
    std::vector<Vec3> centers_; ///< [frames_] horizontal position followed by the camera [m]
    Bounds view_;               ///< of all prepared frames, relative to their centres [m]
    std::optional<preview::Renderer> renderer_;
};

} // namespace toile::app
