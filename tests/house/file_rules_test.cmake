# The checker of files accepts what the rules allow and names what they forbid.
# Script: cmake -D work=<scratch folder> -P file_rules_test.cmake
cmake_minimum_required(VERSION 3.25)
get_filename_component(source_dir ${CMAKE_CURRENT_LIST_DIR}/../.. ABSOLUTE)

# check(<regular expression, empty for none> <file>...): what the checker says of a tree with these.
function(check complaint)
    list(JOIN ARGN "\n" list)
    file(WRITE ${work}/files.txt "${list}\n")
    execute_process(
        COMMAND ${CMAKE_COMMAND} -D root=${work} -D files=${work}/files.txt
            -P ${source_dir}/configs/cmake/check_files.cmake
        RESULT_VARIABLE status OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(complaint STREQUAL "" AND NOT status EQUAL 0)
        message(SEND_ERROR "${ARGN} is allowed, but was refused:\n${output}")
    elseif(NOT complaint STREQUAL "" AND (status EQUAL 0 OR NOT output MATCHES "${complaint}"))
        message(SEND_ERROR "${ARGN}: no '${complaint}' in (${status}):\n${output}")
    endif()
endfunction()

# write(<lines> <head> <file>...)
function(write lines head)
    string(REPEAT "int a;\n" ${lines} text)
    foreach(file IN LISTS ARGN)
        file(WRITE ${work}/${file} "${head}\n${text}")
    endforeach()
endfunction()

file(REMOVE_RECURSE ${work})
write(3 "" engine/plan/a.cpp engine/plan/a.h io/b.cpp engine/main.cpp engine/runtime/no_mpi.cpp)
check("" engine/plan/a.cpp engine/plan/a.h engine/main.cpp engine/runtime/no_mpi.cpp)
check("io/b.cpp: no header" io/b.cpp)

write(399 "// Text." io/long.h)
check("" io/long.h)
write(400 "// Text." io/long.h)
check("io/long.h: 401 lines" io/long.h)
write(400 "// Long because it is one thing." io/long.h)
check("" io/long.h)

foreach(room engine/job io)
    set(modules)
    foreach(i RANGE 1 16)
        write(1 "" ${room}/m${i}.h ${room}/m${i}.cpp)
        list(APPEND modules ${room}/m${i}.h ${room}/m${i}.cpp)
    endforeach()
    check("" ${modules})
    write(1 "" ${room}/m17.h)
    check("${room}: 17 modules" ${modules} ${room}/m17.h)
endforeach()
