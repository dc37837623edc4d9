# Script: cmake -D root=<source tree> -D files=<list file> -P check_includes.cmake
# Fails, naming every offending line, when
#  (1) a file includes a folder above its own: kernels <- io <- engine
#  (2) a heavy library is included elsewhere than through its door (doors.txt)
#  (3) a kernel includes what kernels must not know: threads, files, clocks, logs
# `files` holds one path a line, relative to root.
cmake_minimum_required(VERSION 3.25)

set(forbidden_in_kernels "^(\\.\\./)*(io|engine|tests|bench)/")
set(forbidden_in_io "^(\\.\\./)*(engine|tests|bench)/")
set(forbidden_in_engine "^(\\.\\./)*(tests|bench)/")
set(unknown_to_kernels
    "^(thread|future|stop_token|fstream|filesystem|cstdio|stdio\\.h|chrono|ctime|time\\.h|iostream|unistd\\.h|spdlog/.*)$")

set(doors)
file(STRINGS ${CMAKE_CURRENT_LIST_DIR}/doors.txt door_lines REGEX "^[^#]")
foreach(line IN LISTS door_lines)
    # A pattern may hold "|": the library ends at the first one, the files begin at the last.
    if(NOT line MATCHES "^([^|]*[^| ]) *\\| *(.*[^ ]) *\\| *([^|)]+)$")
        message(FATAL_ERROR "doors.txt: cannot read the line: ${line}")
    endif()
    set(name ${CMAKE_MATCH_1})
    list(APPEND doors ${name})
    set(pattern_${name} "${CMAKE_MATCH_2}")
    string(STRIP "${CMAKE_MATCH_3}" allowed_${name})
    string(REPLACE " " ";" allowed_${name} "${allowed_${name}}")
endforeach()

set(problems "")
file(STRINGS ${files} paths)
foreach(path IN LISTS paths)
    string(REGEX MATCH "^[^/]+" folder ${path})
    file(STRINGS ${root}/${path} lines REGEX "^[ \t]*#[ \t]*include[ \t]*[<\"]")
    foreach(line IN LISTS lines)
        if(NOT line MATCHES "include[ \t]*[<\"]([^>\"]+)[>\"]")
            continue()
        endif()
        set(included ${CMAKE_MATCH_1})
        if(DEFINED forbidden_in_${folder} AND included MATCHES "${forbidden_in_${folder}}")
            string(APPEND problems "  ${path} includes ${included}: ${folder}/ may not look upwards "
                "(kernels <- io <- engine)\n")
        endif()
        if(folder STREQUAL kernels AND included MATCHES "${unknown_to_kernels}")
            string(APPEND problems "  ${path} includes ${included}: kernels know no threads, files, "
                "clocks or logs; pass the value in\n")
        endif()
        foreach(name IN LISTS doors)
            if(NOT included MATCHES "${pattern_${name}}")
                continue()
            endif()
            set(is_door FALSE)
            foreach(allowed IN LISTS allowed_${name})
                string(FIND "${path}" "${allowed}" at)
                if(path STREQUAL allowed OR (allowed MATCHES "/$" AND at EQUAL 0))
                    set(is_door TRUE)
                endif()
            endforeach()
            if(NOT is_door)
                list(JOIN allowed_${name} ", " allowed)
                string(APPEND problems "  ${path} includes ${included}: ${name} may be included only "
                    "in ${allowed} (configs/cmake/doors.txt)\n")
            endif()
        endforeach()
    endforeach()
endforeach()

if(problems)
    message(FATAL_ERROR "Include rules broken:\n${problems}")
endif()
