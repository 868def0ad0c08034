# assimp 5.2. Debian's own config also names draco and minizip targets that it does not define.
if(NOT TARGET Assimp::assimp)
    find_path(ASSIMP_INCLUDE_DIR assimp/Importer.hpp REQUIRED)
    find_library(ASSIMP_LIBRARY assimp REQUIRED)
    add_library(Assimp::assimp INTERFACE IMPORTED)
    target_include_directories(Assimp::assimp INTERFACE "${ASSIMP_INCLUDE_DIR}")
    target_link_libraries(Assimp::assimp INTERFACE "${ASSIMP_LIBRARY}")
endif()
