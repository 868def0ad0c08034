# tinygltf 2.7, its header alone: export/gltf compiles it. Debian's config would link its shared library, with stb.
if(NOT TARGET TinyGltf::header)
    find_path(TINYGLTF_INCLUDE_DIR tiny_gltf.h REQUIRED)
    add_library(TinyGltf::header INTERFACE IMPORTED)
    target_include_directories(TinyGltf::header SYSTEM INTERFACE "${TINYGLTF_INCLUDE_DIR}")
endif()
