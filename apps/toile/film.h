#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/render/camera.h"
#include "apps/render/renderer.h"
#include "export/point_cache.h"
#include "scenes/format/scene.h"
#include "scenes/scene_body.h"
#include "scenes/world.h"

namespace toile {

/// Cloths, solids and avatars over time, ready to be photographed: caches with or without their scene, or a
/// scene's start.
class Film {
public:
    /// The start state of a scene.
    static Film of_scene(const Scene& scene);
    /// Caches of a scene's cloths and solids among its avatars; those without a cache are left out.
    /// @param cloth  which cloth a single cache is; empty: told by its name
    static Film of_caches(const Scene& scene, const std::vector<std::filesystem::path>& caches,
                          const std::string& cloth);
    /// OBJ caches, which carry their own faces.
    /// @throws InvalidInput for a cache without faces.
    static Film of_obj_caches(const std::vector<std::filesystem::path>& caches);

    int frame_count() const { return frame_count_; }
    double fps() const { return settings_.fps; }
    scene::Render& render() { return settings_.render; } ///< size, view and samples, to be changed at will

    /// Prepares pictures of these frames: the view holds all of them, and follows who walks through the
    /// scene.
    void choose(const std::vector<int>& frames);

    /// Picture of one of the frames chosen.
    Image picture(int frame);

private:
    struct Track {
        std::optional<PointCache> cache; ///< absent: `start` for ever
        std::vector<Vec3> start;         ///< [vertices] [m]
        RenderMesh mesh;
    };

    void add_surface(int index, const ClothState& state, std::optional<PointCache> cache);
    void add_cloth(const scene::Cloth& settings, const ObjMesh& rest, const std::vector<Triangle>& triangles,
                   const std::vector<Vec3>& start, std::optional<PointCache> cache);
    std::vector<Vec3> positions(const Track& track, int frame) const;
    bool is_shown(const SceneBody& body) const;
    void show_bodies(int frame);
    Bounds bounds_of(int frame);
    RenderScene render_scene(int frame) const;

    Scene settings_; ///< fps, render; defaults for caches without a scene
    std::vector<SceneBody> bodies_;
    std::vector<Track> tracks_;
    int frame_count_ = 0;
    std::vector<int> frames_;   ///< chosen
    std::vector<Vec3> centers_; ///< [frames_] horizontal place that the camera follows [m]
    Bounds view_;               ///< of all chosen frames about their centres [m]
    std::optional<Renderer> renderer_;
};

} // namespace toile
