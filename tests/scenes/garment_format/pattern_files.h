#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace toile::test {

/// Panel JSON of the data folder, with what FORMATS.md 3.4 and 3.6 says about it. 0: says nothing.
struct PatternFact {
    std::string file; ///< below patterns/
    double area;      ///< [m^2] of all panels together
    double ratio;     ///< [-] largest longest/shortest of a seam
};

inline const std::vector<PatternFact>& pattern_facts()
{
    static const std::vector<PatternFact> kFacts{
        {"garment_pattern_generator/dress_sleeveless.json", 0.0, 0.0},
        {"garment_pattern_generator/pants_flare.json", 0.0, 0.0},
        {"garment_pattern_generator/skirt_2_panels.json", 0.0, 0.0},
        {"garment_pattern_generator/skirt_8_panels.json", 0.0, 0.0},
        {"garment_pattern_generator/skirt_waistband.json", 0.0, 2.22},
        {"garment_pattern_generator/tee.json", 0.0, 0.0},
        {"garmentcode/circle_skirt_mean_all_specification.json", 1.19, 1.11},
        {"garmentcode/dress_circle_mean_all_specification.json", 1.68, 0.0},
        {"garmentcode/dress_gathered_mean_all_specification.json", 1.28, 1.57},
        {"garmentcode/dress_pencil_specification.json", 0.0, 1.30},
        {"garmentcode/long_sleeve_turtle_mean_all_specification.json", 0.83, 0.0},
        {"garmentcode/pants_mean_all_specification.json", 1.16, 0.0},
        {"garmentcode/pencil_skirt_mean_all_specification.json", 0.69, 1.11},
        {"garmentcode/shirt_mean_specification.json", 0.0, 0.0},
        {"garmentcode/tee_mean_all_specification.json", 0.66, 1.02},
    };
    return kFacts;
}

inline std::filesystem::path pattern_file(const std::string& file)
{
    return std::filesystem::path(TOILE_DATA_DIR) / "patterns" / file;
}

} // namespace toile::test

/// Ends the test if the data folder is not there.
#define TOILE_NEED_PATTERNS()                                                                                \
    if (!std::filesystem::exists(toile::test::pattern_file("garmentcode")))                                  \
    GTEST_SKIP() << "SKIPPED: TOILE_DATA_DIR has no patterns/"
