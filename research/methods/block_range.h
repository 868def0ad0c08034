#pragma once

namespace toile::research {

/// Blocks of one colour in a list of blocks sorted by colour.
struct BlockRange {
    int first, count;
};

} // namespace toile::research
