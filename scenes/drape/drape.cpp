#include "scenes/drape/drape.h"

#include <algorithm>
#include <vector>

#include "scenes/drape/drape_watch.h"
#include "scenes/drape/dressed_body.h"
#include "scenes/drape/garment.h"
#include "scenes/drape/garment_draping.h"

namespace toile::scenes {

DrapeResult drape(const DrapeSettings& settings, const WorldOptions& options)
{
    DrapeWatch watch(settings, options);
    std::vector<Garment> garments;
    for (const DrapeGarment& garment : settings.garments)
        garments.emplace_back(garment, settings.shift);
    const bool needs_segments = std::any_of(garments.begin(), garments.end(), [](const Garment& garment) {
        return garment.is_placed_by_segments();
    });
    const DressedBody body(settings.body, needs_segments);
    std::vector<WornGarment> worn;
    DrapeResult result;
    watch.run(
        [&] {
            for (size_t g = 0; g < garments.size() && result.outcome == DrapeOutcome::Draped; ++g)
                GarmentDraping(settings, garments[g], body, worn, watch, result).run();
        },
        result);
    return result;
}

} // namespace toile::scenes
