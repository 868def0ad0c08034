#include <string>

#include "core/base/error.h"
#include "garment/pattern/seam_measure.h"
#include "garment/pattern/sewn_sides.h"
#include "scenes/garment_format/read_garment.h"

/// Panel JSON and garment files: what is read can be measured, what is not is refused in one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const toile::garment::Pattern pattern =
            toile::garment_format::parse_pattern({reinterpret_cast<const char*>(data), size}, "pattern.json");
        for (const toile::garment::Seam& seam : pattern.seams)
            if (!(measure_seam(pattern, seam).ratio() >= 1.0))
                std::abort();
        static_cast<void>(sewn_sides(pattern));
    } catch (const toile::InvalidInput& error) {
        if (std::string(error.what()).find('\n') != std::string::npos)
            std::abort();
    }
    return 0;
}
