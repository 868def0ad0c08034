#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "apps/preview/paint/paint.h"
#include "core/compute/types.h"
#include "core/mesh/triangle_mesh.h"

namespace toile::preview {

enum class Print { Plain, Checker, Stripes };

/// Appearance of a surface. Colours are linear RGB in [0, 1].
struct Material {
    Vec3 front = Vec3(0.80, 0.78, 0.75); ///< side on which triangles are counter-clockwise
    Vec3 back = Vec3(0.80, 0.78, 0.75);
    double sheen = 0.0;        ///< soft light of fibres at grazing angles [-], 0 none, 1 velvet
    double gloss = 0.0;        ///< blurred highlight of the sun [-], 0 none
    double translucency = 0.0; ///< fraction of the sun that shines through to the shaded side [-]

    Print print = Print::Plain;
    Vec3 print_front = Vec3::Ones(); ///< second colour of the print on the front
    double print_size = 0.05;        ///< side of a square or width of a stripe, in corner_coordinates
};

/// Matt woven fabric: sheen, some light shining through, the back side a paler tone of the front.
Material cloth_material(const Vec3& front);
/// Calm grey-beige of a mannequin.
Material mannequin_material();

/// One surface of the picture.
struct RenderMesh {
    std::vector<Vec3> positions;     ///< [vertices] [m]
    std::vector<Triangle> triangles; ///< [triangles]
    Material material;

    /// Print coordinates per triangle corner, from texture or rest coordinates; only for prints.
    std::vector<std::array<Vec2, 3>> corner_coordinates;

    std::shared_ptr<const Paint> paint; ///< in place of the material's colours and print; may be null
};

/// Corner coordinates from a 2-D rest shape [vertices] [m].
std::vector<std::array<Vec2, 3>> corner_coordinates(View<const Triangle> triangles, View<const Vec2> rest);

struct RenderScene {
    std::vector<RenderMesh> meshes;
    std::optional<double> ground_height; ///< [m] of an endless floor that fades into the background
};

} // namespace toile::preview
