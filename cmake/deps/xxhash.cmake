# xxHash 0.8: XXH3, the hash of keys and the checksum of files. Debian ships no CMake config for it.
find_path(XXHASH_INCLUDE_DIR xxhash.h REQUIRED)
find_library(XXHASH_LIBRARY xxhash REQUIRED)
add_library(xxHash_xxhash INTERFACE)
add_library(xxHash::xxhash ALIAS xxHash_xxhash)
target_include_directories(xxHash_xxhash SYSTEM INTERFACE "${XXHASH_INCLUDE_DIR}")
target_link_libraries(xxHash_xxhash INTERFACE "${XXHASH_LIBRARY}")
