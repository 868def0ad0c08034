#pragma once

#include <string>

namespace toile::test {

/// Panel JSON of a tube: a front and a back panel, 20 cm high, whose sides are sewn. In metres.
inline std::string tube(double width, const std::string& label, double front = 0.14)
{
    const auto panel = [&](double z, bool is_back) {
        const double w = 0.5 * width;
        // Seen from the outside of the body both loops are counter-clockwise.
        const std::string left = std::to_string(is_back ? w : -w), right = std::to_string(is_back ? -w : w);
        return R"({"vertices": [[)" + left + ", -0.1], [" + right + ", -0.1], [" + right + ", 0.1], [" +
               left +
               R"(, 0.1]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3])" +
               (label.empty() ? "" : R"(, "label": ")" + label + "\"") +
               R"(}, {"endpoints": [3, 0]}], "rotation": [0, 0, 0], "translation": [0, 0, )" +
               std::to_string(z) + "]}";
    };
    return R"({"pattern": {"panels": {"front": )" + panel(front, false) + R"(, "back": )" +
           panel(-0.14, true) +
           R"(}, "stitches": [[{"panel": "front", "edge": 1}, {"panel": "back", "edge": 3}],
               [{"panel": "front", "edge": 3}, {"panel": "back", "edge": 1}]]},
           "properties": {"units_in_meter": 1, "curvature_coords": "relative"}})";
}

} // namespace toile::test
