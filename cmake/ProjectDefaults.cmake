# Language level, warnings and output folders for every target of ours.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()

# Rebuilds after a branch switch cost seconds instead of minutes where ccache is installed.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND PROJECT_IS_TOP_LEVEL)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
endif()

option(TOILE_NATIVE "Compile for this machine's instruction set (vector width decides the solver's speed)" ON)

# toile_options: an interface target with the flags of our own code, never exported to consumers.
add_library(toile_options INTERFACE)
# GCC 12 warns about its own vector intrinsics and std::string; clang-tidy finds the real cases.
target_compile_options(toile_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow -Wno-uninitialized -Wno-maybe-uninitialized -Wno-restrict>)
# nvcc: every warning is an error, above all host functions called by a kernel. 20012 are defaulted functions of
# Eigen with a marker, which has no effect on them. Eigen calls constexpr functions of the standard library.
target_compile_options(toile_options INTERFACE
    "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;-diag-suppress=20012>"
    "$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-Werror cross-execution-space-call -Werror all-warnings>"
    "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wno-unknown-pragmas>")
# The instruction set decides Eigen's alignment, so the host's part of .cu files must be told the same.
if(TOILE_NATIVE)
    target_compile_options(toile_options INTERFACE
        $<$<COMPILE_LANGUAGE:CXX>:-march=native> $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-march=native>)
endif()
# Contraction into fused multiply-adds stays on: results are the same for every thread count, not for every
# processor.
target_compile_definitions(toile_options INTERFACE
    $<$<NOT:$<CONFIG:Release>>:TOILE_CHECKED> EIGEN_DONT_PARALLELIZE)
