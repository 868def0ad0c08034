#pragma once

namespace toile {

/// The blocks of one colour in a list of blocks laid out colour by colour.
struct BlockRange {
    int first, count;
};

} // namespace toile
