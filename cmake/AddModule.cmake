# Headers that most sources include, precompiled: once for the modules and programs, once more with GoogleTest for the
# tests. They are of the system only, so that no change of ours compiles everything again.
option(TOILE_PRECOMPILE "Precompile the headers of the system" ON)
set(TOILE_PRECOMPILED_HEADERS
    <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits> <map> <memory> <optional> <string>
    <utility> <vector> <experimental/simd>
    <Eigen/Core> <Eigen/Geometry>
    <tbb/blocked_range.h> <tbb/enumerable_thread_specific.h> <tbb/global_control.h> <tbb/parallel_for.h>
    <tbb/task_arena.h>)

# toile_precompile(<target> <owner> [HEADERS <more>...] [LIBRARIES <whose they are>...] [OPTIONS <of the compiler>...])
# The target's C++ sources see the headers precompiled by the owner, a target that is made for that on first use.
function(toile_precompile target owner)
    if(NOT TOILE_PRECOMPILE)
        return()
    endif()
    cmake_parse_arguments(MORE "" "" "HEADERS;LIBRARIES;OPTIONS" ${ARGN})
    if(NOT TARGET ${owner})
        set(source "${PROJECT_BINARY_DIR}/${owner}.cpp")
        file(CONFIGURE OUTPUT "${source}" CONTENT "// Precompiles headers.\n")
        add_library(${owner} OBJECT "${source}")
        set_property(TARGET ${owner} PROPERTY EXPORT_COMPILE_COMMANDS OFF)
        target_link_libraries(${owner} PRIVATE Eigen3::Eigen TBB::tbb ${MORE_LIBRARIES} toile_options)
        target_compile_options(${owner} PRIVATE ${MORE_OPTIONS})
        list(TRANSFORM TOILE_PRECOMPILED_HEADERS REPLACE "(.+)" "$<$<COMPILE_LANGUAGE:CXX>:\\1>" OUTPUT_VARIABLE headers)
        foreach(header IN LISTS MORE_HEADERS)
            list(APPEND headers "$<$<COMPILE_LANGUAGE:CXX>:${header}>")
        endforeach()
        target_precompile_headers(${owner} PRIVATE ${headers})
    endif()
    target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()

# add_module(<name> SOURCES ... DEPENDS <our modules> [CUDA <files.cu>] [PUBLIC <targets>] [PRIVATE <targets>])
#
# One static library per folder: target toile_<name>, alias toile::<name>. DEPENDS are the only folders whose
# headers it may include; the property TOILE_DEPENDS keeps them for the layering test (tests/layering.py).
# Third parties go into PRIVATE unless a public header includes them. CUDA: launchers of kernels (cuda.cmake).
function(add_module name)
    cmake_parse_arguments(MODULE "" "" "SOURCES;DEPENDS;CUDA;PUBLIC;PRIVATE" ${ARGN})
    set(target toile_${name})
    add_library(${target} STATIC ${MODULE_SOURCES})
    add_library(toile::${name} ALIAS ${target})
    target_include_directories(${target} PUBLIC "$<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}>")
    list(TRANSFORM MODULE_DEPENDS PREPEND toile:: OUTPUT_VARIABLE module_targets)
    target_link_libraries(${target}
        PUBLIC ${module_targets} ${MODULE_PUBLIC} toile_abi
        PRIVATE ${MODULE_PRIVATE} $<BUILD_INTERFACE:toile_options>)
    toile_precompile(${target} toile_precompiled)
    if(MODULE_CUDA)
        toile_cuda_sources(${target} "${MODULE_CUDA}" "${module_targets};${MODULE_PUBLIC}")
    endif()
    set_property(GLOBAL APPEND PROPERTY TOILE_LAYERS "${name}:${MODULE_DEPENDS}")
endfunction()

set(TOILE_TEST_OPTIONS "$<$<AND:$<CONFIG:Release>,$<COMPILE_LANGUAGE:CXX>>:-O1>")

# add_toile_test(<folder> SOURCES ... DEPENDS <our modules> [CUDA <files.cu>] [PRIVATE <targets>])
# One GoogleTest program per folder of tests/, each test case registered with ctest. TOILE_CACHE_DIR is empty in
# all of them (no_cache.cpp). Tests leave their work to the modules, so that optimising them is not worth its time.
function(add_toile_test folder)
    cmake_parse_arguments(TEST "" "" "SOURCES;DEPENDS;CUDA;PRIVATE" ${ARGN})
    set(target test_${folder})
    add_executable(${target} ${TEST_SOURCES} "${PROJECT_SOURCE_DIR}/tests/support/no_cache.cpp")
    list(TRANSFORM TEST_DEPENDS PREPEND toile:: OUTPUT_VARIABLE test_targets)
    target_link_libraries(${target} PRIVATE ${test_targets} ${TEST_PRIVATE} GTest::gtest_main toile_options)
    target_compile_options(${target} PRIVATE ${TOILE_TEST_OPTIONS})
    target_compile_definitions(${target} PRIVATE
        TOILE_DATA_DIR="${TOILE_DATA_DIR}" TOILE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    toile_precompile(${target} toile_precompiled_tests
        HEADERS <gtest/gtest.h> <gmock/gmock.h> LIBRARIES GTest::gtest GTest::gmock OPTIONS ${TOILE_TEST_OPTIONS})
    if(TEST_CUDA)
        toile_cuda_sources(${target} "${TEST_CUDA}" "${test_targets}")
    endif()
    gtest_discover_tests(${target} NO_PRETTY_VALUES DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
