# cmake --install: programs, static libraries with their headers, the CMake package `toile`, pages and licences.

include(GNUInstallDirs)
include(CMakePackageConfigHelpers)
include(third_party)
set(headers_dir "${CMAKE_INSTALL_INCLUDEDIR}/toile")
set(package_dir "${CMAKE_INSTALL_LIBDIR}/cmake/toile")

install(TARGETS toile RUNTIME)
install(TARGETS toile-bench RUNTIME OPTIONAL)

# The libraries below toile::toile; each is toile::<name>, as in this build.
set(libraries core quadrature2d volume volume_meshing garment pattern_mesh collision collision_check collision_repair collision_skin avatars
    export scene_format garment_format scenes drape)
foreach(name IN LISTS libraries ITEMS abi)
    set_property(TARGET toile_${name} PROPERTY EXPORT_NAME ${name})
endforeach()
set_property(TARGET toile_library PROPERTY EXPORT_NAME toile)
list(TRANSFORM libraries PREPEND toile_)
install(TARGETS ${libraries} toile_library toile_abi EXPORT toileTargets
    ARCHIVE INCLUDES DESTINATION "${headers_dir}")

# Without headers that show nlohmann_json or CGAL, which are for sources of their own folder alone, and folders without headers.
install(FILES toile.h DESTINATION "${headers_dir}")
install(DIRECTORY core quadrature2d volume garment collision avatars export scenes DESTINATION "${headers_dir}"
    FILES_MATCHING PATTERN "*.h" PATTERN "*.cuh"
    REGEX "garment/pattern/mesh/panel_triangulation\\.h$" EXCLUDE
    REGEX "avatars/import/gltf_(accessors|clips|file|json|meshes|nodes|uri)\\.h$" EXCLUDE
    REGEX "scenes/format/(schema/)?(checks|document|names|range_check|reader|schema_writer)\\.h$" EXCLUDE
    REGEX "scenes/garment_format/(assemble|edge_name|panel_json)\\.h$" EXCLUDE
    REGEX "(avatars/model/cuda|scenes/(benchmarks|contact|data|demo))$" EXCLUDE)

# What find_package(toile) reads; the recipes find what the static libraries link.
configure_package_config_file(cmake/toileConfig.cmake.in "${PROJECT_BINARY_DIR}/toileConfig.cmake"
    INSTALL_DESTINATION "${package_dir}" NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file("${PROJECT_BINARY_DIR}/toileConfigVersion.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${PROJECT_BINARY_DIR}/toileConfig.cmake" "${PROJECT_BINARY_DIR}/toileConfigVersion.cmake"
    DESTINATION "${package_dir}")
install(DIRECTORY cmake/deps DESTINATION "${package_dir}")
install(EXPORT toileTargets NAMESPACE toile:: DESTINATION "${package_dir}")

# The pages refer to each other from where they lie in the tree.
toile_write_third_party()
install(FILES README.md CHANGELOG.md LICENSE NOTICE "${PROJECT_BINARY_DIR}/THIRD_PARTY.txt"
    DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(DIRECTORY cmake/licences docs DESTINATION "${CMAKE_INSTALL_DOCDIR}")
install(FILES docs/reference/toile.schema.json docs/reference/toile_garment.schema.json DESTINATION "${CMAKE_INSTALL_DATADIR}/toile")
