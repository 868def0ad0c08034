#include "avatars/model/appearance.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>

#include "core/base/error.h"

namespace toile::avatars {

namespace {

/// Corner of `t` at each corner of `goal`; none if they are different triangles.
std::optional<std::array<size_t, 3>> corners_at(const Triangle& t, const Triangle& goal)
{
    std::array<size_t, 3> corners{};
    for (int k = 0; k < 3; ++k) {
        const auto corner = std::find(t.begin(), t.end(), goal[k]);
        if (corner == t.end())
            return std::nullopt;
        corners[size_t(k)] = size_t(corner - t.begin());
    }
    return corners;
}

template <typename Value>
void turn(std::array<Value, 3>& values, const std::array<size_t, 3>& corners)
{
    values = {values[corners[0]], values[corners[1]], values[corners[2]]};
}

} // namespace

double linear_from_srgb(double encoded)
{
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

int Appearance::add_white()
{
    materials.emplace_back().colour = Vec3::Ones();
    return int(materials.size()) - 1;
}

int Appearance::add_image_file(const std::filesystem::path& model, const std::string& name,
                               const std::string& place)
{
    std::string slashed = name;
    std::replace(slashed.begin(), slashed.end(), '\\', '/');
    const std::filesystem::path path(slashed);
    const std::array candidates{model.parent_path() / path, model.parent_path() / path.filename()};
    const auto file = std::find_if(candidates.begin(), candidates.end(), [](const auto& candidate) {
        std::error_code unreadable;
        return std::filesystem::is_regular_file(candidate, unreadable);
    });
    const bool is_there = file != candidates.end();
    StoredImage image{place, {}};
    if (is_there) {
        std::ifstream stream(*file, std::ios::binary);
        image = {file->string(), {std::istreambuf_iterator<char>(stream), {}}};
        files.push_back(*file);
    }
    if (image.bytes.empty())
        left_out.push_back(place + ": image \"" + name +
                           (is_there ? "\": is empty, or can't be read" : "\": no such file"));
    images.push_back(std::move(image));
    return int(images.size()) - 1;
}

void turn_corners(Appearance& appearance, const std::vector<Triangle>& triangles, const std::string& source)
{
    const auto require = [&](bool is_same) {
        if (!is_same)
            throw InvalidInput(source + ": has changed since it was loaded; start again");
    };
    require(appearance.triangles.size() == triangles.size());
    for (size_t t = 0; t < triangles.size(); ++t) {
        if (appearance.triangles[t] == triangles[t])
            continue;
        const auto corners = corners_at(appearance.triangles[t], triangles[t]);
        require(corners.has_value());
        if (!appearance.coordinates.empty())
            turn(appearance.coordinates[t], *corners);
        if (!appearance.colours.empty())
            turn(appearance.colours[t], *corners);
    }
    appearance.triangles = triangles;
}

} // namespace toile::avatars
