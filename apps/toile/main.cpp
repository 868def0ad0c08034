#include "apps/toile/command_line.h"
#include "core/backend/cuda/runtime.h"

int main(int argc, char** argv)
{
    toile::cuda::load_kernels_early();
    return toile::run_command_line(argc, argv);
}
