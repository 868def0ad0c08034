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
        PUBLIC ${module_targets} ${MODULE_PUBLIC}
        PRIVATE ${MODULE_PRIVATE} $<BUILD_INTERFACE:toile_options>)
    if(MODULE_CUDA)
        toile_cuda_sources(${target} "${MODULE_CUDA}" "${module_targets};${MODULE_PUBLIC}")
    endif()
    set_property(GLOBAL APPEND PROPERTY TOILE_LAYERS "${name}:${MODULE_DEPENDS}")
endfunction()

# add_toile_test(<folder> SOURCES ... DEPENDS <our modules> [CUDA <files.cu>] [PRIVATE <targets>])
# One GoogleTest program per folder of tests/, each test case registered with ctest. TOILE_CACHE_DIR is empty in
# all of them (no_cache.cpp).
function(add_toile_test folder)
    cmake_parse_arguments(TEST "" "" "SOURCES;DEPENDS;CUDA;PRIVATE" ${ARGN})
    set(target test_${folder})
    add_executable(${target} ${TEST_SOURCES} "${PROJECT_SOURCE_DIR}/tests/support/no_cache.cpp")
    list(TRANSFORM TEST_DEPENDS PREPEND toile:: OUTPUT_VARIABLE test_targets)
    target_link_libraries(${target} PRIVATE ${test_targets} ${TEST_PRIVATE} GTest::gtest_main toile_options)
    target_compile_definitions(${target} PRIVATE
        TOILE_DATA_DIR="${TOILE_DATA_DIR}" TOILE_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    if(TEST_CUDA)
        toile_cuda_sources(${target} "${TEST_CUDA}" "${test_targets}")
    endif()
    gtest_discover_tests(${target} DISCOVERY_TIMEOUT 60 PROPERTIES TIMEOUT 300)
endfunction()
