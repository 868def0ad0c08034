# assimp 5.2. Debian's own config also names draco and minizip targets that it does not define.
find_path(ASSIMP_INCLUDE_DIR assimp/Importer.hpp REQUIRED)
find_library(ASSIMP_LIBRARY assimp REQUIRED)
add_library(Assimp_assimp INTERFACE)
add_library(Assimp::assimp ALIAS Assimp_assimp)
target_include_directories(Assimp_assimp SYSTEM INTERFACE "${ASSIMP_INCLUDE_DIR}")
target_link_libraries(Assimp_assimp INTERFACE "${ASSIMP_LIBRARY}")
