# xxHash 0.8: XXH3, the hash of keys and the checksum of files. Debian ships no CMake config for it.
if(NOT TARGET xxHash::xxhash)
    find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
    find_library(XXHASH_LIBRARY xxhash REQUIRED)
    add_library(xxHash::xxhash INTERFACE IMPORTED)
    target_include_directories(xxHash::xxhash INTERFACE "${XXHASH_INCLUDE_DIR}")
    target_link_libraries(xxHash::xxhash INTERFACE "${XXHASH_LIBRARY}")
endif()
