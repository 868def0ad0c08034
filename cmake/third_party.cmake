# Writes THIRD_PARTY.txt into the build folder: the libraries of this build, with the versions that CMake found.

# toile_header_version(<out> <header> <macro>...): the numbers of the macros, joined by dots.
function(toile_header_version out header)
    set(numbers "")
    foreach(macro IN LISTS ARGN)
        file(STRINGS "${header}" line REGEX "define +${macro} " LIMIT_COUNT 1)
        string(REGEX MATCH "${macro} +([0-9]+)" line "${line}")
        list(APPEND numbers "${CMAKE_MATCH_1}")
    endforeach()
    list(JOIN numbers "." version)
    set(${out} "${version}" PARENT_SCOPE)
endfunction()

function(toile_write_third_party)
    # Packages with a CMake config, found by the folders that own them.
    get_directory_property(embree_version DIRECTORY collision DEFINITION embree_VERSION)
    get_directory_property(cgal_version DIRECTORY collision/check DEFINITION CGAL_VERSION)
    get_directory_property(boost_version DIRECTORY collision/check DEFINITION Boost_VERSION_STRING)
    get_directory_property(json_version DIRECTORY scenes/format DEFINITION nlohmann_json_VERSION)
    get_directory_property(png_version DIRECTORY apps/preview DEFINITION PNG_VERSION_STRING)
    get_directory_property(jpeg_version DIRECTORY apps/preview DEFINITION JPEG_VERSION)
    get_directory_property(zlib_version DIRECTORY apps/preview DEFINITION ZLIB_VERSION_STRING)
    get_directory_property(cli_version DIRECTORY apps/toile DEFINITION CLI11_VERSION)

    # The others say it in a header, assimp in the name of its library.
    toile_header_version(cholmod_version "${CHOLMOD_INCLUDE_DIR}/cholmod_core.h"
        CHOLMOD_MAIN_VERSION CHOLMOD_SUB_VERSION CHOLMOD_SUBSUB_VERSION)
    toile_header_version(suitesparse_version "${CHOLMOD_INCLUDE_DIR}/SuiteSparse_config.h"
        SUITESPARSE_MAIN_VERSION SUITESPARSE_SUB_VERSION SUITESPARSE_SUBSUB_VERSION)
    toile_header_version(xxhash_version "${XXHASH_INCLUDE_DIR}/xxhash.h"
        XXH_VERSION_MAJOR XXH_VERSION_MINOR XXH_VERSION_RELEASE)
    toile_header_version(gmp_version "${GMP_INCLUDE_DIR}/gmp.h"
        __GNU_MP_VERSION __GNU_MP_VERSION_MINOR __GNU_MP_VERSION_PATCHLEVEL)
    file(REAL_PATH "${ASSIMP_LIBRARY}" assimp_file)
    string(REGEX MATCH "[0-9][0-9.]*$" assimp_version "${assimp_file}")

    set(cuda_part "")
    set(cub_copyright "")
    if(TOILE_WITH_CUDA)
        string(CONCAT cuda_part "CUDA runtime ${CUDAToolkit_VERSION}, static (libcudart_static): NVIDIA CUDA EULA\n"
            "CCCL of that toolkit, headers: Apache-2.0 (Thrust), Apache-2.0 with LLVM exceptions (libcu++), "
            "BSD-3-Clause (CUB)\n")
        string(CONCAT cub_copyright "\nCUB\nCopyright (c) 2011, Duane Merrill. All rights reserved.\n"
            "Copyright (c) 2011-2022, NVIDIA CORPORATION. All rights reserved.\n")
    endif()
    configure_file("${PROJECT_SOURCE_DIR}/cmake/third_party.txt.in" "${PROJECT_BINARY_DIR}/THIRD_PARTY.txt" @ONLY)
endfunction()
