#include <string>

#include "core/base/error.h"
#include "scenes/format/read_scene.h"
#include "scenes/format/validate.h"

/// Scene files: what is read must be valid, what is not is refused in one line.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    try {
        const toile::scenes::Scene scene =
            toile::scenes::parse_scene({reinterpret_cast<const char*>(data), size}, "scene.json");
        toile::scenes::require_valid(scene);
    } catch (const toile::InvalidInput& error) {
        if (std::string(error.what()).find('\n') != std::string::npos)
            std::abort();
    }
    return 0;
}
