#pragma once

#include <utility>
#include <vector>

namespace toile::garment {

/// Settings of an energy for cloth of one or several fabrics.
template <typename Settings>
struct ByFabric {
    std::vector<Settings> settings;      ///< [fabrics]
    std::vector<int> fabric_of_triangle; ///< [triangles] into settings; empty: all are of the first

    ByFabric(const Settings& one) : settings{one} {}
    ByFabric(std::vector<Settings> of_fabrics, std::vector<int> of_triangles)
        : settings(std::move(of_fabrics)), fabric_of_triangle(std::move(of_triangles))
    {
    }

    int fabric_of(int triangle) const
    {
        return fabric_of_triangle.empty() ? 0 : fabric_of_triangle[size_t(triangle)];
    }
    const Settings& at(int triangle) const { return settings[size_t(fabric_of(triangle))]; }
};

} // namespace toile::garment
