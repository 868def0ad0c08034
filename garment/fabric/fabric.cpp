#include "garment/fabric/fabric.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"

namespace toile::garment {

void Fabric::validate(const std::string& source) const
{
    const auto require = [&](bool good, const char* property, double value, const char* range) {
        if (!good || !std::isfinite(value))
            throw InvalidInput(source + ": fabric \"" + name + "\": " + property + " = " +
                               std::to_string(value) + "; it must be " + range);
    };
    require(areal_density > 0.0, "areal_density", areal_density, "positive [kg/m^2]");
    require(thickness > 0.0, "thickness", thickness, "positive [m]");
    require(stretch_warp > 0.0, "stretch warp", stretch_warp, "positive [N/m]");
    require(stretch_weft > 0.0, "stretch weft", stretch_weft, "positive [N/m]");
    require(shear > 0.0 && shear <= 0.5 * std::min(stretch_warp, stretch_weft), "shear", shear,
            "positive and at most half of the smaller stretch modulus [N/m]");
    require(bend_warp >= 0.0, "bend warp", bend_warp, "0 or more [N m]");
    require(bend_weft >= 0.0, "bend weft", bend_weft, "0 or more [N m]");
    require(strain_limit > 0.0, "strain_limit", strain_limit, "positive [-]");
    require(damping >= 0.0, "damping", damping, "0 or more [1/s]");
    require(stretch_damping >= 0.0, "stretch_damping", stretch_damping, "0 or more [s]");
    require(shear_damping >= 0.0, "shear_damping", shear_damping, "0 or more [s]");
    require(bend_damping >= 0.0, "bend_damping", bend_damping, "0 or more [s]");
    require(bend_friction >= 0.0, "bend_friction", bend_friction, "0 or more [1/m]");
}

const std::vector<Fabric>& fabric_presets()
{
    // name, kg/m^2, thickness m, warp, weft, shear N/m, bend warp, weft N m, strain limit
    static const std::vector<Fabric> presets{
        {"canvas", 0.400, 0.66e-3, 2000.0, 1600.0, 200.0, 70e-6, 50e-6, 0.03},
        {"cotton", 0.1503, 0.318e-3, 261.1, 261.1, 105.0, 2.338e-6, 2.338e-6, 0.0608},
        {"denim", 0.400, 0.66e-3, 1500.0, 1200.0, 150.0, 60e-6, 35e-6, 0.04},
        {"jersey", 0.180, 0.60e-3, 60.0, 40.0, 18.0, 2.0e-6, 1.5e-6, 0.25},
        {"polyester", 0.1646, 0.252e-3, 120.5, 120.5, 43.6, 0.7457e-6, 0.7457e-6, 0.0646},
        {"silk", 0.060, 0.18e-3, 300.0, 250.0, 30.0, 1.2e-6, 1.0e-6, 0.05},
        {"wool", 0.2348, 0.568e-3, 96.6, 96.6, 37.8, 2.812e-6, 2.812e-6, 0.085},
        {"wool_lycra", 0.1782, 0.328e-3, 24.9, 24.9, 11.6, 0.2246e-6, 0.2246e-6, 0.134},
    };
    return presets;
}

const Fabric& fabric_preset(const std::string& name, const std::string& source)
{
    std::vector<std::string> names;
    for (const Fabric& fabric : fabric_presets()) {
        if (fabric.name == name)
            return fabric;
        names.push_back(fabric.name);
    }
    std::string list;
    for (const std::string& known : names)
        list += (list.empty() ? "" : ", ") + known;
    const std::string nearest = nearest_word(name, names);
    throw InvalidInput(source + ": no fabric \"" + name + "\"" +
                       (nearest.empty() ? "" : "; did you mean \"" + nearest + "\"?") + " Fabrics: " + list);
}

} // namespace toile::garment
