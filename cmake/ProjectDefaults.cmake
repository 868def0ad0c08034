# Language level, warnings and output folders for every target of ours.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/bin")

if(NOT CMAKE_BUILD_TYPE AND NOT CMAKE_CONFIGURATION_TYPES)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release, RelWithDebInfo or Debug" FORCE)
endif()

# Rebuilds after a branch switch cost seconds instead of minutes where ccache is installed. Precompiled headers need
# the slack that its manual names for them.
find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM AND PROJECT_IS_TOP_LEVEL)
    set(CMAKE_CXX_COMPILER_LAUNCHER "${CMAKE_COMMAND}" -E env CCACHE_SLOPPINESS=pch_defines,time_macros
        "${CCACHE_PROGRAM}")
    add_compile_options($<$<COMPILE_LANG_AND_ID:CXX,GNU>:-fpch-preprocess>)
endif()

option(TOILE_NATIVE "Compile for this machine's instruction set (vector width decides the solver's speed)" ON)

# toile_abi: flags that layouts and inline functions of our headers depend on. Programs that link a module get them too.
add_library(toile_abi INTERFACE)
target_compile_features(toile_abi INTERFACE cxx_std_20)
# No contraction into fused multiply-adds: copies of one kernel, inlined where it runs serially and where a scheduler
# calls it, would be contracted differently, and results would depend on how work was shared between threads.
target_compile_options(toile_abi INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-ffp-contract=off> $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-ffp-contract=off>)
# The instruction set decides Eigen's alignment, so the host's part of .cu files must be told the same.
if(TOILE_NATIVE)
    target_compile_options(toile_abi INTERFACE
        $<$<COMPILE_LANGUAGE:CXX>:-march=native> $<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-march=native>)
endif()
# Our configuration decides about checks, not that of the program that links us.
set(is_checked "$<NOT:$<CONFIG:Release>>")
if(NOT CMAKE_CONFIGURATION_TYPES)
    string(COMPARE NOTEQUAL "${CMAKE_BUILD_TYPE}" Release is_checked)
endif()
target_compile_definitions(toile_abi INTERFACE EIGEN_DONT_PARALLELIZE $<${is_checked}:TOILE_CHECKED>)
# Vectors and matrices that nobody has written are NaN in checked builds. Kernels keep theirs as they are: shared
# memory of a GPU has no constructors.
target_compile_definitions(toile_abi INTERFACE
    $<$<AND:${is_checked},$<COMPILE_LANGUAGE:CXX>>:EIGEN_INITIALIZE_MATRICES_BY_NAN>)

# toile_options: flags of our own code alone.
add_library(toile_options INTERFACE)
target_link_libraries(toile_options INTERFACE toile_abi)
# GCC 12 warns about its own vector intrinsics and std::string; clang-tidy finds the real cases.
target_compile_options(toile_options INTERFACE
    $<$<COMPILE_LANGUAGE:CXX>:-Wall -Wextra -Wshadow>
    $<$<COMPILE_LANG_AND_ID:CXX,GNU>:-Wno-uninitialized -Wno-maybe-uninitialized -Wno-restrict>)
# nvcc: every warning is an error, above all host functions called by a kernel. 20012 are defaulted functions of
# Eigen with a marker, which has no effect on them. Eigen calls constexpr functions of the standard library.
target_compile_options(toile_options INTERFACE
    "$<$<COMPILE_LANGUAGE:CUDA>:--expt-relaxed-constexpr;-diag-suppress=20012>"
    "$<$<COMPILE_LANGUAGE:CUDA>:SHELL:-Werror cross-execution-space-call -Werror all-warnings>"
    "$<$<COMPILE_LANGUAGE:CUDA>:-Xcompiler=-Wall,-Wextra,-Wno-unknown-pragmas>")

# Address and undefined-behaviour sanitizers: the preset "sanitize". Checks of every single access (null, alignment,
# object-size) are left out: they take half of the compiler's time, and the address sanitizer stops at the same.
option(TOILE_SANITIZE "Stop at memory errors and undefined behaviour" OFF)
if(TOILE_SANITIZE)
    set(sanitizers -fno-sanitize-recover=all
        -fsanitize=address,bounds,shift,integer-divide-by-zero,signed-integer-overflow,return,unreachable,bool,enum)
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:${sanitizers};-fno-omit-frame-pointer>")
    add_link_options(${sanitizers})
    target_link_options(toile_abi INTERFACE ${sanitizers})
endif()

# Parsers with libFuzzer: the preset "fuzz", for clang.
option(TOILE_FUZZ "Instrument for libFuzzer (tests/fuzz)" OFF)
if(TOILE_FUZZ)
    add_compile_options("$<$<COMPILE_LANGUAGE:CXX>:-fsanitize=fuzzer-no-link>")
endif()
