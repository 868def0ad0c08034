#pragma once

#include <vector>

#include "garment/pattern/pattern.h"

namespace toile::garment_format {

/// Mirror image of a panel on the other side of the body: x of the world to -x. Its loop is reversed, so that
/// its normal points away from the body too: edge i becomes edge count - 1 - i, from its end to its start.
/// Left and right change places in labels and in `place`.
garment::Panel mirror_image(const garment::Panel& panel);

/// How often a panel is cut.
struct Cut {
    int copies = 1;
    bool mirror = false; ///< every second copy is a mirror image
};

/// Adds the copies of panels, NAME_2, NAME_3 and so on, and repeats seams between panels that are cut
/// equally.
/// @param cuts  [panels]
void add_copies(garment::Pattern& pattern, const std::vector<Cut>& cuts);

/// Name of a copy: k = 0 is the panel itself.
std::string name_of_copy(const std::string& panel, int k);

} // namespace toile::garment_format
