#include "export/usd/usd_frames.h"
#include "core/base/error.h"
#include "tests/fuzz/input_file.h"

namespace exports = toile::exports;

/// What the Python commands for USD leave: every frame, up to a number.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr int kFrames = 20;
    static const toile::test::InputFile file(".frames");
    try {
        const auto cache = exports::open_usd_frames(
            std::make_unique<exports::BinaryFile>(file.write(data, size), exports::BinaryFile::Mode::Read),
            "fuzz");
        for (int frame = 0; frame < std::min(cache->frame_count, kFrames); ++frame)
            static_cast<void>(cache->frame(frame));
    } catch (const toile::InvalidInput&) {
    }
    return 0;
}
