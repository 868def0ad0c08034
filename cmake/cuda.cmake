# Says whether this machine could build for a GPU. No kernel of ours is compiled for one yet, so the language
# is looked for but not enabled: a missing or broken toolkit never stops a build.
include(CheckLanguage)
check_language(CUDA)
if(CMAKE_CUDA_COMPILER)
    message(STATUS "CUDA: found ${CMAKE_CUDA_COMPILER} (not used yet: CPU build)")
else()
    message(STATUS "CUDA: not found (CPU build)")
endif()
