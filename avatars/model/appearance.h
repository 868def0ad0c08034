#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "core/compute/types.h"

namespace toile::avatars {

/// Linear value of an sRGB one, both in [0, 1].        [IEC 61966-2-1]
double linear_from_srgb(double encoded);

/// Where an image continues outside of [0, 1].
enum class Wrap { Repeat, Mirror, Clamp };

/// An image as its file stores it.
struct StoredImage {
    std::string place;                ///< "body.glb: images[0]", for messages
    std::vector<unsigned char> bytes; ///< PNG or JPEG; empty if it is missing, see Appearance::left_out
};

/// An image on a surface.
struct Texture {
    int image = -1; ///< in Appearance::images
    std::array<Wrap, 2> wrap{Wrap::Repeat, Wrap::Repeat};
};

/// Colour of a part of a surface: the product of a colour, a texture, and colours at vertices.
struct SurfaceMaterial {
    std::optional<Vec3> colour; ///< [-] linear RGB; the file may leave it out
    double alpha = 1.0;         ///< [-]
    double cutoff = 0.0;        ///< [-] nothing is there where alpha is lower
    std::optional<Texture> texture;
};

/// Place in an image of the corners of a triangle.
using CornerCoordinates = std::array<Vec2, 3>;

/// Colour and alpha at the corners of a triangle: linear RGB, then alpha [-].
using CornerColours = std::array<Eigen::Vector4d, 3>;

/// How the file of a body colours it. For pictures: nothing of it is read for a simulation.
struct Appearance {
    std::vector<Triangle> triangles; ///< vertices of the body at the corners
    std::vector<StoredImage> images;
    std::vector<SurfaceMaterial> materials;
    std::vector<int> material; ///< [triangles] -1: none

    /// [triangles] place in the image, from its upper left (0, 0) to its lower right (1, 1). May be empty.
    std::vector<CornerCoordinates> coordinates;
    std::vector<CornerColours> colours; ///< [triangles] or empty

    std::vector<std::filesystem::path> files; ///< that were read for it; of glTF see files_of_gltf()
    std::vector<std::string> left_out;        ///< what can't be shown, one line each: a missing image

    bool is_empty() const { return materials.empty(); }

    /// Adds a white material, for colours at vertices.
    /// @return its index
    int add_white();

    /// Adds the image that a model names: by its path from the model, or else by its name beside the model,
    /// as paths of other machines lead nowhere.
    /// @param place  in the model, for messages
    /// @return its index
    int add_image_file(const std::filesystem::path& model, const std::string& name, const std::string& place);
};

/// Turns corners of triangles to the order that the body has them in.
/// @throws InvalidInput naming `source` if it is of another body
void turn_corners(Appearance& appearance, const std::vector<Triangle>& triangles, const std::string& source);

} // namespace toile::avatars
