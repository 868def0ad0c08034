#pragma once

#include <string>

#include "scenes/garment_format/read_garment.h"
#include "tests/support/refusal.h"
#include "tests/support/temporary_folder.h"

namespace toile::test {

/// Panel of a panel JSON, in centimetres: a rectangle with its lower left corner at the origin, edges bottom,
/// right, top, left; more keys may follow.
inline std::string panel_text(const std::string& name, double width, double height,
                              const std::string& more = "")
{
    const std::string w = std::to_string(width);
    const std::string h = std::to_string(height);
    return "\"" + name + "\": {\"vertices\": [[0, 0], [" + w + ", 0], [" + w + ", " + h + "], [0, " + h +
           R"(]], "edges": [{"endpoints": [0, 1]}, {"endpoints": [1, 2]}, {"endpoints": [2, 3]},
                            {"endpoints": [3, 0]}])" +
           (more.empty() ? "" : ", " + more) + "}";
}

inline std::string stitch_text(const std::string& a, int edge_a, const std::string& b, int edge_b)
{
    return "[{\"panel\": \"" + a + "\", \"edge\": " + std::to_string(edge_a) + "}, {\"panel\": \"" + b +
           "\", \"edge\": " + std::to_string(edge_b) + "}]";
}

inline std::string panel_json(const std::string& panels, const std::string& stitches = "",
                              const std::string& properties = "\"units_in_meter\": 100")
{
    return "{\"pattern\": {\"panels\": {" + panels + "}, \"stitches\": [" + stitches +
           "]}, \"properties\": {" + properties + "}}";
}

/// Front and back of a tube of 40 x 60 cm.
inline std::string tube_json()
{
    return panel_json(panel_text("front", 40, 60) + ", " + panel_text("back", 40, 60),
                      stitch_text("front", 1, "back", 3) + ", " + stitch_text("front", 3, "back", 1));
}

/// Error about a text; empty if there is none.
inline std::string pattern_complaint(const std::string& text)
{
    return refusal([&] { static_cast<void>(garment_format::parse_pattern(text, "bad.json")); });
}

} // namespace toile::test
