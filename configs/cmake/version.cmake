# vfplan_version.h: version, commit and build type. Written again at build time, and only when
# something in it changed.

set(version_dir ${PROJECT_BINARY_DIR}/generated)
add_custom_target(vfplan_version_header
    COMMAND ${CMAKE_COMMAND}
        -D source_dir=${PROJECT_SOURCE_DIR}
        -D version=${PROJECT_VERSION}
        -D build_type=${CMAKE_BUILD_TYPE}
        -D template=${CMAKE_CURRENT_LIST_DIR}/vfplan_version.h.in
        -D output=${version_dir}/vfplan_version.h
        -P ${CMAKE_CURRENT_LIST_DIR}/write_version.cmake
    BYPRODUCTS ${version_dir}/vfplan_version.h
    COMMENT "Asking git for the version" VERBATIM)

add_library(vfplan_version INTERFACE)
target_include_directories(vfplan_version INTERFACE ${version_dir})
add_dependencies(vfplan_version vfplan_version_header)
