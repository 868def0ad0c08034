#include "core/base/error.h"
#include "export/ply/ply_file.h"
#include "tests/fuzz/input_file.h"

/// PLY meshes, and their positions alone.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const toile::test::InputFile input(".ply");
    const std::filesystem::path& file = input.write(data, size);
    for (const bool whole : {true, false}) {
        try {
            if (whole)
                static_cast<void>(toile::exports::read_ply(file));
            else
                static_cast<void>(toile::exports::read_ply_positions(file));
        } catch (const toile::InvalidInput&) {
        }
    }
    return 0;
}
