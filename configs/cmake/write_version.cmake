# Script: cmake -D source_dir= -D version= -D build_type= -D template= -D output= -P this
find_program(git git)
set(describe "")
if(git)
    execute_process(COMMAND ${git} describe --always --dirty --tags
        WORKING_DIRECTORY ${source_dir} OUTPUT_VARIABLE describe
        OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
endif()
if(NOT describe)
    set(describe unknown)  # a source archive without history
endif()
configure_file(${template} ${output} @ONLY)
