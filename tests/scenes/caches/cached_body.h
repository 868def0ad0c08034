#pragma once

#include <string>
#include <vector>

#include "export/cache_writer.h"
#include "scenes/format/scene.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace scenes;

/// Samples that a DCC program wrote (tests/dcc/bake_bodies.py): slide and bend, each as .abc, .glb and .usdc.
inline std::filesystem::path baked(const std::string& name)
{
    return std::filesystem::path(TOILE_SOURCE_DIR) / "tests/scenes/caches/samples" / name;
}

/// A closed tube about Z, 0.5 m long and 0.25 m wide, of quads with hexagons at its ends. Every number is
/// exact in single precision, in all samples.
inline ObjMesh tube()
{
    constexpr int kRings = 5, kCorners = 6;
    const Vec2 corners[kCorners] = {Vec2(8, 0),  Vec2(4, 7),   Vec2(-4, 7),
                                    Vec2(-8, 0), Vec2(-4, -7), Vec2(4, -7)};
    ObjMesh mesh;
    for (int r = 0; r < kRings; ++r)
        for (const Vec2& corner : corners)
            mesh.positions.push_back(Vec3(corner.x() / 64.0, corner.y() / 64.0, r / 8.0));
    for (int r = 0; r + 1 < kRings; ++r)
        for (int k = 0; k < kCorners; ++k) {
            const int a = r * kCorners + k, b = r * kCorners + (k + 1) % kCorners;
            mesh.polygons.push_back({a, b, b + kCorners, a + kCorners});
        }
    mesh.polygons.push_back({5, 4, 3, 2, 1, 0});
    mesh.polygons.push_back({24, 25, 26, 27, 28, 29});
    return mesh;
}

/// Positions of the tube in a sample: it moves by (1/64, 0, 0) and swells by 1/16 of its width.
inline std::vector<Vec3> tube_at(int sample)
{
    std::vector<Vec3> x = tube().positions;
    for (Vec3& p : x)
        p = Vec3(p.x() * (1.0 + sample / 16.0) + sample / 64.0, p.y() * (1.0 + sample / 16.0), p.z());
    return x;
}

/// Writes samples of the tube to a cache of any format.
inline std::filesystem::path write_tube(const std::filesystem::path& file, int samples,
                                        const exports::CacheLayout& like = {})
{
    exports::CacheLayout layout = exports::cache_layout(tube(), samples);
    layout.fps = like.fps;
    layout.subframes = like.subframes;
    layout.start_frame = like.start_frame;
    const auto writer = exports::make_cache_writer(file, layout);
    for (int k = 0; k < samples; ++k)
        writer->write(k, tube_at(k));
    writer->finish();
    return file;
}

/// A cached avatar as a scene describes it.
inline scene::Avatar cached_avatar(const std::filesystem::path& file)
{
    scene::Avatar avatar;
    avatar.name = "body";
    avatar.shape = file;
    avatar.self_contact = scene::SelfContact::Keep;
    return avatar;
}

} // namespace toile::test
