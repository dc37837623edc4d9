# Rules that the build itself checks. All are part of the default target.

# Include direction, rooms and doors: a scan of the #include lines. Names and sizes of files.
vfplan_sources(scanned
    kernels/*.h kernels/*.cpp io/*.h io/*.cpp engine/*.h engine/*.cpp tests/*.h tests/*.cpp)
list(TRANSFORM scanned REPLACE "^${PROJECT_SOURCE_DIR}/" "" OUTPUT_VARIABLE scanned_relative)
set(include_stamp ${PROJECT_BINARY_DIR}/generated/include_checks.stamp)
set(include_list ${PROJECT_BINARY_DIR}/generated/include_checks.txt)
list(JOIN scanned_relative "\n" scanned_text)
file(CONFIGURE OUTPUT ${include_list} CONTENT "${scanned_text}\n" @ONLY)
vfplan_sources(bench_sources bench/*.h bench/*.cpp)
list(TRANSFORM bench_sources REPLACE "^${PROJECT_SOURCE_DIR}/" "" OUTPUT_VARIABLE bench_relative)
set(file_list ${PROJECT_BINARY_DIR}/generated/file_checks.txt)
list(JOIN bench_relative "\n" bench_text)
file(CONFIGURE OUTPUT ${file_list} CONTENT "${scanned_text}\n${bench_text}\n" @ONLY)
add_custom_command(OUTPUT ${include_stamp}
    COMMAND ${CMAKE_COMMAND}
        -D root=${PROJECT_SOURCE_DIR} -D files=${include_list}
        -P ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake
    COMMAND ${CMAKE_COMMAND}
        -D root=${PROJECT_SOURCE_DIR} -D files=${file_list}
        -P ${CMAKE_CURRENT_LIST_DIR}/check_files.cmake
    COMMAND ${CMAKE_COMMAND} -E touch ${include_stamp}
    DEPENDS ${scanned} ${bench_sources} ${include_list} ${file_list}
        ${CMAKE_CURRENT_LIST_DIR}/doors.txt ${CMAKE_CURRENT_LIST_DIR}/rooms.txt
        ${CMAKE_CURRENT_LIST_DIR}/check_includes.cmake ${CMAKE_CURRENT_LIST_DIR}/check_files.cmake
    COMMENT "Checking floors, rooms, library doors and files" VERBATIM)
add_custom_target(include_checks ALL DEPENDS ${include_stamp})

# Every header compiles alone: one source per header that includes it twice and nothing else.
set(header_globs kernels/*.h io/*.h engine/*.h)
if(VFPLAN_TESTS)
    list(APPEND header_globs tests/*.h)
endif()
vfplan_sources(headers ${header_globs})
set(header_sources)
foreach(header IN LISTS headers)
    file(RELATIVE_PATH header ${PROJECT_SOURCE_DIR} ${header})
    string(MAKE_C_IDENTIFIER ${header} id)
    set(source ${PROJECT_BINARY_DIR}/generated/headers/${id}.cpp)
    file(CONFIGURE OUTPUT ${source} CONTENT "#include \"${header}\"\n#include \"${header}\"\n")
    list(APPEND header_sources ${source})
endforeach()
# Once is enough: not again beside benchmarks, harnesses and sanitizers.
if(header_sources AND VFPLAN_TESTS AND NOT VFPLAN_SANITIZE)
    add_library(header_checks OBJECT ${header_sources})
    # The folder's library for its include paths; no optimisation, the objects are thrown away.
    # And those of headers that are doors themselves.
    target_link_libraries(header_checks PRIVATE
        vfplan_flags vfplan_engine PkgConfig::cairo vfplan::hdf5)
    target_compile_options(header_checks PRIVATE -O0)
    target_compile_definitions(header_checks PRIVATE VFPLAN_SOURCE_DIR="" VFPLAN_BINARY="")
    target_link_libraries(header_checks PRIVATE GTest::gtest)
else()
    add_custom_target(header_checks)
endif()
