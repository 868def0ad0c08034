#include "core/base/error.h"
#include "export/point_cache.h"
#include "tests/fuzz/input_file.h"

/// Point caches. The first byte chooses the format.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const toile::test::InputFile pc2(".pc2"), partial(".partial.pc2"), mdd(".mdd");
    if (size == 0)
        return 0;
    const toile::test::InputFile& file = data[0] % 3 == 0 ? pc2 : data[0] % 3 == 1 ? mdd : partial;
    try {
        const toile::exports::PointCache cache = toile::exports::read_cache(file.write(data + 1, size - 1));
        for (int frame = 0; frame < cache.frame_count(); ++frame)
            static_cast<void>(cache.frame(frame));
    } catch (const toile::InvalidInput&) {
    }
    return 0;
}
