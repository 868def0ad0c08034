# SuiteSparse's CHOLMOD with METIS. Debian ships no CMake config for it.
find_path(CHOLMOD_INCLUDE_DIR cholmod.h PATH_SUFFIXES suitesparse REQUIRED)
find_library(CHOLMOD_LIBRARY cholmod REQUIRED)
find_library(SUITESPARSE_CONFIG_LIBRARY suitesparseconfig REQUIRED)
add_library(SuiteSparse_cholmod INTERFACE)
add_library(SuiteSparse::cholmod ALIAS SuiteSparse_cholmod)
target_include_directories(SuiteSparse_cholmod SYSTEM INTERFACE "${CHOLMOD_INCLUDE_DIR}")
target_link_libraries(SuiteSparse_cholmod INTERFACE "${CHOLMOD_LIBRARY}" "${SUITESPARSE_CONFIG_LIBRARY}")
