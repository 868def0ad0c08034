# Embree 3.13: bounding volume hierarchies, ray and point queries. Debian ships a CMake config (target embree).
find_package(embree 3.13 REQUIRED CONFIG)
