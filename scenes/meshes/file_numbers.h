#pragma once

#include <vector>

namespace toile::scenes {

/// Numbers of the vertices of a file where a cloth has others: its seams are joined, its loose vertices
/// dropped.
struct FileNumbers {
    std::vector<int> vertex;      ///< [file vertices] the cloth's vertex that each goes along with
    std::vector<int> file_vertex; ///< [the cloth's vertices that are in the file] the first with each
    std::vector<int> loose;       ///< file vertices without a face, ascending
};

} // namespace toile::scenes
