#pragma once

#include <utility>
#include <vector>

namespace toile::garment {

/// Settings of an energy for cloth of one or several fabrics.
template <typename Settings>
struct ByFabric {
    std::vector<Settings> settings;      ///< [fabrics]
    std::vector<int> fabric_of_triangle; ///< [triangles] into settings; empty: all are of the first
    std::vector<double> stiffness;       ///< [triangles] factor on stiffnesses of the settings [-]; empty: 1

    ByFabric(const Settings& one) : settings{one} {}
    ByFabric(std::vector<Settings> of_fabrics, std::vector<int> of_triangles,
             std::vector<double> stiffness_of_triangles = {})
        : settings(std::move(of_fabrics)), fabric_of_triangle(std::move(of_triangles)),
          stiffness(std::move(stiffness_of_triangles))
    {
    }

    int fabric_of(int triangle) const
    {
        return fabric_of_triangle.empty() ? 0 : fabric_of_triangle[size_t(triangle)];
    }
    const Settings& at(int triangle) const { return settings[size_t(fabric_of(triangle))]; }
    double stiffness_of(int triangle) const { return stiffness.empty() ? 1.0 : stiffness[size_t(triangle)]; }
};

} // namespace toile::garment
