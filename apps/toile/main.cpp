#include <CLI/CLI.hpp>

#include "apps/toile/terminal/command_line.h"
#include "core/base/blas_memory.h"
#include "core/compute/cuda/runtime/runtime.h"

namespace {

std::vector<toile::app::Command> add_commands(CLI::App& parser)
{
    using namespace toile::app;
    return {add_simulate(parser, nullptr),
            add_drape(parser),
            add_render(parser),
            add_check(parser),
            add_fit(parser),
            add_info(parser),
            add_measure(parser),
            add_convert(parser),
            add_mesh(parser),
            add_pattern(parser),
            add_schema(parser)};
}

} // namespace

int main(int argc, char** argv)
{
    toile::leave_out_blas_threads(argv);
    toile::cuda::load_kernels_eagerly();
    return toile::app::run_command_line(
        argc, argv, {"toile", "Simulates cloth and garments on animated bodies.", add_commands});
}
