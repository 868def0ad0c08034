#pragma once

#include <string_view>

namespace toile::research::paper {

/// A row of the paper's Table 1: milliseconds on an RTX 4090 by "cull", "narrow", "LG" and "total". The
/// caption says that those of several objects are averages an object; the text calls them times of a step.
struct Published {
    std::string_view scene; ///< stem of the scene's file
    double dofs;
    double iterations;
    double cull_ms, narrow_ms, local_global_ms, total_ms;
    double move; ///< change of a position at which iterations end [m]
};

inline constexpr Published kTable1[] = {
    {"tree", 793e3, 19, 3.5, 13.7, 74, 95, 2e-3},       {"stiff_letters", 534e3, 18, 2.1, 3.3, 14, 22, 2e-3},
    {"letters", 534e3, 12, 2.1, 3.9, 11, 19, 2e-3},     {"blender", 499e3, 18, 5.7, 18.3, 46, 74, 2e-3},
    {"ship", 422e3, 19, 11.2, 52.1, 56, 123, 1e-3},     {"ships", 8.5e6, 27, 174, 1303, 2133, 3749, 1e-3},
    {"puffers", 3.3e6, 17, 33.4, 91.2, 783, 912, 1e-3}, {"cloth", 150e3, 42, 5.7, 17.8, 31, 57, 1e-3},
    {"runway", 722e3, 42, 7.7, 27.2, 133, 176, 1e-3},   {"funnel", 523e3, 32, 9.1, 34.3, 60, 109, 1e-3},
};

/// Null: the paper has no such scene.
inline const Published* published(std::string_view scene)
{
    for (const Published& row : kTable1)
        if (row.scene == scene)
            return &row;
    return nullptr;
}

} // namespace toile::research::paper
