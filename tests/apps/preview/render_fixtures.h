#pragma once

#include <cmath>
#include <numbers>

#include "apps/preview/renderer.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

using namespace preview;

using RenderFileTest = FileTest;

/// Square of side 2 around `center`, facing +Z, or +Y if lying.
inline RenderMesh square(const Vec3& center, bool lying)
{
    RenderMesh mesh;
    for (const Vec2& corner : {Vec2(-1, -1), Vec2(1, -1), Vec2(1, 1), Vec2(-1, 1)}) {
        const Vec3 offset(corner.x(), lying ? 0.0 : corner.y(), lying ? -corner.y() : 0.0);
        mesh.positions.push_back(center + offset);
    }
    mesh.triangles = {Triangle(0, 1, 2), Triangle(0, 2, 3)};
    return mesh;
}

/// Unit sphere by longitude and latitude.
inline RenderMesh unit_sphere(int segments)
{
    RenderMesh mesh;
    const int rings = segments / 2;
    for (int j = 0; j <= rings; ++j)
        for (int i = 0; i < segments; ++i) {
            const double a = 2.0 * std::numbers::pi * i / segments, b = std::numbers::pi * j / rings;
            mesh.positions.push_back(Vec3(std::sin(b) * std::sin(a), std::cos(b), std::sin(b) * std::cos(a)));
        }
    for (int j = 0; j < rings; ++j)
        for (int i = 0; i < segments; ++i) {
            const int a = j * segments + i, b = j * segments + (i + 1) % segments;
            mesh.triangles.push_back(Triangle(a, a + segments, b + segments));
            mesh.triangles.push_back(Triangle(a, b + segments, b));
        }
    return mesh;
}

inline int brightness(const std::uint8_t* pixel) { return pixel[0] + pixel[1] + pixel[2]; }

inline const std::uint8_t* pixel_at(const Image& image, const Vec2& picture_coordinates)
{
    return image.pixel(int(0.5 * (picture_coordinates.x() + 1.0) * image.width),
                       int(0.5 * (1.0 - picture_coordinates.y()) * image.height));
}

} // namespace toile::test
