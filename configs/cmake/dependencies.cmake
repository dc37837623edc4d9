# Every third-party library, from the system (configs/packages/debian.txt lists the packages).
# All are imported targets, so their headers count as SYSTEM and stay silent.

find_package(PkgConfig REQUIRED)
find_package(Threads REQUIRED)
find_package(Eigen3 3.4 REQUIRED NO_MODULE)
find_package(embree 3 REQUIRED)
find_package(TBB REQUIRED)
find_package(hwy REQUIRED)
find_package(GDAL 3.4 REQUIRED)
find_package(GEOS 3.10 REQUIRED)
find_package(OpenSSL REQUIRED COMPONENTS Crypto)
find_package(ZLIB REQUIRED)
find_package(fmt REQUIRED)
find_package(CLI11 REQUIRED)
find_package(tomlplusplus REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(pugixml REQUIRED)
find_package(yaml-cpp REQUIRED)
find_path(VFPLAN_POTRACE_INCLUDE potracelib.h REQUIRED)
find_library(VFPLAN_POTRACE potrace REQUIRED)
add_library(vfplan::potrace INTERFACE IMPORTED)
target_include_directories(vfplan::potrace SYSTEM INTERFACE ${VFPLAN_POTRACE_INCLUDE})
target_link_libraries(vfplan::potrace INTERFACE ${VFPLAN_POTRACE})
find_path(VFPLAN_GLPK_INCLUDE glpk.h REQUIRED)
find_library(VFPLAN_GLPK glpk REQUIRED)
add_library(vfplan::glpk INTERFACE IMPORTED)
target_include_directories(vfplan::glpk SYSTEM INTERFACE ${VFPLAN_GLPK_INCLUDE})
target_link_libraries(vfplan::glpk INTERFACE ${VFPLAN_GLPK})
pkg_check_modules(cairo REQUIRED IMPORTED_TARGET cairo)
pkg_check_modules(png REQUIRED IMPORTED_TARGET libpng)
if(VFPLAN_TESTS)
    find_package(GTest REQUIRED)
endif()
if(VFPLAN_BENCH)
    find_package(benchmark REQUIRED)
endif()

# CGAL is header-only. Its CMake package would put -frounding-math on everything that links it,
# so we name the headers and the two number libraries ourselves.
find_path(VFPLAN_CGAL_INCLUDE CGAL/version.h REQUIRED)
find_path(VFPLAN_GMP_INCLUDE gmp.h REQUIRED)
find_path(VFPLAN_BOOST_INCLUDE boost/version.hpp REQUIRED)
find_library(VFPLAN_GMP gmp REQUIRED)
find_library(VFPLAN_MPFR mpfr REQUIRED)
add_library(vfplan::cgal INTERFACE IMPORTED)
target_include_directories(vfplan::cgal SYSTEM INTERFACE
    ${VFPLAN_CGAL_INCLUDE} ${VFPLAN_GMP_INCLUDE} ${VFPLAN_BOOST_INCLUDE})
target_link_libraries(vfplan::cgal INTERFACE ${VFPLAN_MPFR} ${VFPLAN_GMP})

# HDF5, the serial C library. Where the OpenMPI flavour is installed too, it takes over
# pkg-config and the plain names; it is not thread-safe, so it is never what we want.
find_path(VFPLAN_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial PATHS /usr/include
          NO_DEFAULT_PATH)
find_path(VFPLAN_HDF5_INCLUDE hdf5.h REQUIRED)
find_library(VFPLAN_HDF5 NAMES hdf5_serial hdf5 REQUIRED)
find_library(VFPLAN_HDF5_HL NAMES hdf5_serial_hl hdf5_hl REQUIRED)
file(GLOB hdf5_config_headers ${VFPLAN_HDF5_INCLUDE}/H5pubconf*.h)
foreach(header IN LISTS hdf5_config_headers)
    file(STRINGS ${header} parallel REGEX "^#define H5_HAVE_PARALLEL")
    if(parallel)
        message(FATAL_ERROR "${VFPLAN_HDF5_INCLUDE} is a parallel HDF5, which is not thread-safe. "
            "Install the serial one (Debian: libhdf5-dev) or set VFPLAN_HDF5_INCLUDE and VFPLAN_HDF5.")
    endif()
endforeach()
add_library(vfplan::hdf5 INTERFACE IMPORTED)
target_include_directories(vfplan::hdf5 SYSTEM INTERFACE ${VFPLAN_HDF5_INCLUDE})
target_link_libraries(vfplan::hdf5 INTERFACE ${VFPLAN_HDF5_HL} ${VFPLAN_HDF5})

# MPI, its C interface, where it is wanted and found. Its C++ interface would be a library more.
set(VFPLAN_WITH_MPI OFF)
if(NOT VFPLAN_MPI MATCHES "^(AUTO|ON|OFF)$")
    message(FATAL_ERROR "VFPLAN_MPI is ${VFPLAN_MPI}, but only AUTO, ON and OFF have a meaning")
elseif(NOT VFPLAN_MPI STREQUAL OFF)
    enable_language(C)  # FindMPI looks for the interfaces of enabled languages only
    find_package(MPI COMPONENTS C QUIET)
    if(MPI_C_FOUND)
        set(VFPLAN_WITH_MPI ON)
    elseif(VFPLAN_MPI STREQUAL ON)
        message(FATAL_ERROR "VFPLAN_MPI is ON, but no MPI was found. Install one (Debian: "
            "libopenmpi-dev openmpi-bin), or leave it at AUTO: the program is the same for one process")
    endif()
endif()
message(STATUS "MPI: ${VFPLAN_WITH_MPI} ${MPI_C_VERSION}")
