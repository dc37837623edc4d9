# Sources are found by folder, so that adding a file needs no edit here.

# vfplan_sources(<out> <glob>...): matching files in the folders and below, looked for again at every
# build.
function(vfplan_sources out)
    file(GLOB_RECURSE found CONFIGURE_DEPENDS ${ARGN})
    set(${out} ${found} PARENT_SCOPE)
endfunction()

# vfplan_library(<name> <folder> [EXCLUDE <file>...]): static library of the .cpp files of a folder and
# its rooms.
function(vfplan_library name folder)
    cmake_parse_arguments(arg "" "" "EXCLUDE" ${ARGN})
    set(dir ${PROJECT_SOURCE_DIR}/${folder})
    vfplan_sources(sources ${dir}/*.cpp)
    foreach(file IN LISTS arg_EXCLUDE)
        list(REMOVE_ITEM sources ${dir}/${file})
    endforeach()
    if(NOT sources)
        set(sources ${PROJECT_BINARY_DIR}/generated/empty.cpp)
        file(CONFIGURE OUTPUT ${sources} CONTENT "// No sources in ${folder}/ yet.\n")
    endif()
    add_library(${name} STATIC ${sources})
    target_include_directories(${name} PUBLIC ${PROJECT_SOURCE_DIR})
    target_link_libraries(${name} PRIVATE vfplan_flags)
endfunction()
