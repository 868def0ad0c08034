#include "core/base/error.h"
#include "export/alembic/abc_cache.h"
#include "tests/fuzz/input_file.h"

/// Alembic archives: every frame of every mesh, up to a number.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    constexpr int kFrames = 20;
    static const toile::test::InputFile file(".abc");
    try {
        const std::filesystem::path& archive = file.write(data, size);
        for (const std::string& mesh : toile::exports::abc_mesh_paths(archive)) {
            const auto cache = toile::exports::open_abc(archive.string() + "#" + mesh);
            for (int frame = 0; frame < std::min(cache->frame_count, kFrames); ++frame)
                static_cast<void>(cache->frame(frame));
        }
    } catch (const toile::InvalidInput&) {
    }
    return 0;
}
