#include "volume/mesh/msh.h"
#include "core/base/error.h"
#include "tests/fuzz/input_file.h"

/// Tetrahedra of soft bodies.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
    static const toile::test::InputFile file(".msh");
    try {
        toile::volume::boundary_surface(toile::volume::read_msh_tets(file.write(data, size)));
    } catch (const toile::InvalidInput&) {
    }
    return 0;
}
