# How our own code is compiled. Targets link vfplan_flags privately; nothing leaks to others.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_CXX_FLAGS_RELEASE "-O3 -DNDEBUG")
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${CMAKE_BINARY_DIR})

if(NOT CMAKE_BUILD_TYPE)
    set(CMAKE_BUILD_TYPE Release CACHE STRING "Release | Debug" FORCE)
endif()

find_program(VFPLAN_CCACHE ccache)
if(VFPLAN_CCACHE AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    set(CMAKE_CXX_COMPILER_LAUNCHER ${VFPLAN_CCACHE})
endif()

add_library(vfplan_flags INTERFACE)
target_compile_features(vfplan_flags INTERFACE cxx_std_20)
target_compile_options(vfplan_flags INTERFACE
    -Wall -Wextra -Wpedantic -Wshadow -Wconversion
    # The same bits on every machine: no fused multiply-add, and (by absence) neither
    # -march=native nor -ffast-math.
    -ffp-contract=off)
if(VFPLAN_WERROR)
    target_compile_options(vfplan_flags INTERFACE -Werror)
endif()

if(VFPLAN_SANITIZE)
    add_compile_options(-fsanitize=${VFPLAN_SANITIZE} -fno-omit-frame-pointer
                        -fno-sanitize-recover=all)
    add_link_options(-fsanitize=${VFPLAN_SANITIZE})
    # GCC's flow analysis sees ghosts in instrumented code; the plain builds keep these warnings.
    target_compile_options(vfplan_flags INTERFACE
        -Wno-maybe-uninitialized -Wno-stringop-overflow -Wno-array-bounds)
endif()
