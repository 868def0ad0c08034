# TOILE_CUDA: whether kernels are also compiled for NVIDIA GPUs. Sets TOILE_WITH_CUDA.
#
#   AUTO  where a CUDA compiler is found that works (CUDA 12.3 or newer), a build without otherwise
#   ON    stops with an error where there is none
#   OFF   never
#
# Programs of such a build start on machines without a GPU or a driver: the CUDA runtime is linked statically and
# looks for the driver when it is first called.
set(TOILE_CUDA AUTO CACHE STRING "Compile kernels for NVIDIA GPUs too: AUTO, ON or OFF")
set_property(CACHE TOILE_CUDA PROPERTY STRINGS AUTO ON OFF)
set(TOILE_WITH_CUDA OFF)

# Sets `missing` in the caller: empty, or why no kernel can be compiled here.
function(toile_look_for_cuda)
    set(missing "" PARENT_SCOPE)
    # One host compiler for .cpp and .cu, so that inline functions and layouts are the same.
    if(NOT CMAKE_CUDA_HOST_COMPILER)
        set(CMAKE_CUDA_HOST_COMPILER "${CMAKE_CXX_COMPILER}" CACHE FILEPATH "C++ compiler that nvcc calls")
    endif()
    # The toolkit's usual place is often not in PATH.
    if(NOT CMAKE_CUDA_COMPILER AND NOT DEFINED ENV{CUDACXX})
        find_program(nvcc nvcc HINTS ENV CUDA_PATH PATHS /usr/local/cuda PATH_SUFFIXES bin NO_CACHE)
        if(nvcc)
            set(ENV{CUDACXX} "${nvcc}")
        endif()
    endif()
    include(CheckLanguage)
    check_language(CUDA)
    if(NOT CMAKE_CUDA_COMPILER)
        set(missing "no working CUDA compiler found" PARENT_SCOPE)
        return()
    endif()
    execute_process(COMMAND "${CMAKE_CUDA_COMPILER}" --version OUTPUT_VARIABLE banner ERROR_QUIET)
    if(NOT banner MATCHES "release ([0-9]+\\.[0-9]+)")
        set(missing "${CMAKE_CUDA_COMPILER} is not nvcc" PARENT_SCOPE)
    elseif(CMAKE_MATCH_1 VERSION_LESS 12.3)
        set(missing "${CMAKE_CUDA_COMPILER} is ${CMAKE_MATCH_1}, 12.3 or newer is needed" PARENT_SCOPE)
    endif()
endfunction()

string(TOUPPER "${TOILE_CUDA}" wish)
if(wish STREQUAL "AUTO" OR wish)
    # PTX for what comes after, machine code for Hopper. Must be set before the language is enabled.
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES AND NOT DEFINED ENV{CUDAARCHS})
        set(CMAKE_CUDA_ARCHITECTURES "80-virtual;90-real" CACHE STRING "GPUs that kernels are compiled for")
    endif()
    toile_look_for_cuda()
    if(NOT missing)
        enable_language(CUDA)
        find_package(CUDAToolkit REQUIRED)
        set(TOILE_WITH_CUDA ON)
        message(STATUS "CUDA: ${CMAKE_CUDA_COMPILER} ${CMAKE_CUDA_COMPILER_VERSION}, "
                       "architectures ${CMAKE_CUDA_ARCHITECTURES}")
    elseif(wish STREQUAL "AUTO")
        message(STATUS "CUDA: ${missing} (build without it)")
    else()
        message(FATAL_ERROR "TOILE_CUDA=${TOILE_CUDA}, but ${missing}; install the CUDA toolkit, name its nvcc with "
                            "CMAKE_CUDA_COMPILER, or say TOILE_CUDA=OFF")
    endif()
else()
    message(STATUS "CUDA: switched off (TOILE_CUDA=${TOILE_CUDA})")
endif()

if(TOILE_WITH_CUDA)
    set(CMAKE_CUDA_STANDARD 20)
    set(CMAKE_CUDA_STANDARD_REQUIRED ON)
    set(CMAKE_CUDA_EXTENSIONS OFF)
    # CMake 3.25 does not know that nvcc has C++20.
    if(NOT CMAKE_CUDA20_STANDARD_COMPILE_OPTION)
        set(CMAKE_CUDA20_STANDARD_COMPILE_OPTION "-std=c++20")
    endif()
    if(CCACHE_PROGRAM AND PROJECT_IS_TOP_LEVEL)
        set(CMAKE_CUDA_COMPILER_LAUNCHER "${CCACHE_PROGRAM}")
    endif()
endif()

# toile_cuda_sources(<target> <files.cu> <targets whose headers they see>)
#
# Adds .cu files to a target: compiled by nvcc, or, in a build without CUDA, as the C++ that they also are
# (parallel.cuh). The objects come from a library of their own, so that programs are still linked by the C++
# compiler with the C++ flags.
function(toile_cuda_sources target files libraries)
    if(NOT TOILE_WITH_CUDA)
        set_source_files_properties(${files} PROPERTIES LANGUAGE CXX COMPILE_DEFINITIONS TOILE_CU_AS_CXX)
        target_sources(${target} PRIVATE ${files})
        return()
    endif()
    add_library(${target}_cuda OBJECT ${files})
    target_include_directories(${target}_cuda PRIVATE "${PROJECT_SOURCE_DIR}")
    target_link_libraries(${target}_cuda PRIVATE ${libraries} toile_options)
    # Headers seen through -isystem lose their errors: a host function called by a kernel would become a trap.
    set_target_properties(${target}_cuda PROPERTIES NO_SYSTEM_FROM_IMPORTED ON POSITION_INDEPENDENT_CODE ON)
    target_sources(${target} PRIVATE $<TARGET_OBJECTS:${target}_cuda>)
    target_link_libraries(${target} PRIVATE CUDA::cudart_static)
endfunction()
