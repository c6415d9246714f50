# Configures everything where nothing but the compiler and Eigen can be found, and reads the summary.
#   cmake -D SOURCE_DIR=<repository> -D WORK_DIR=<scratch> -D EIGEN_DIR=<folder of Eigen3Config.cmake> -D CXX=<compiler>
#         -D GENERATOR=<name> -D MAKE_PROGRAM=<file> -P without_libraries.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/checks/findings.cmake")

file(REMOVE_RECURSE "${WORK_DIR}")
execute_process(
    COMMAND "${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${WORK_DIR}" -G "${GENERATOR}" "-DCMAKE_MAKE_PROGRAM=${MAKE_PROGRAM}"
        "-DCMAKE_CXX_COMPILER=${CXX}" "-DEigen3_DIR=${EIGEN_DIR}" "-DCMAKE_IGNORE_PREFIX_PATH=/;/usr;/usr/local"
        -DSOFTTISSUE_BUILD_BENCHMARKS=ON
    OUTPUT_VARIABLE summary ERROR_VARIABLE summary RESULT_VARIABLE code)
if(NOT code EQUAL 0)
    message(FATAL_ERROR "the configuration failed:\n${summary}")
endif()
foreach(line IN ITEMS
        "softtissue::io: OFF, needs (Debian) libzip-dev libtinygltf-dev nlohmann-json3-dev"
        "softtissue::cholmod: OFF, needs (Debian) libsuitesparse-dev"
        "softtissue::mpi: OFF, needs (Debian) libopenmpi-dev"
        "unit and law tests: OFF, needs (Debian) doctest-dev"
        "scenario tests: OFF, needs (Debian) catch2")
    string(FIND "${summary}" "${line}" place)
    if(place EQUAL -1)
        report("not in the summary: ${line}")
    endif()
endforeach()
foreach(part IN ITEMS examples benchmarks)
    if(NOT summary MATCHES "${part}: OFF, needs \\(Debian\\) [a-z]")
        report("not in the summary: ${part}: OFF, needs (Debian) ...")
    endif()
endforeach()
file(REMOVE_RECURSE "${WORK_DIR}")
conclude("the summary:\n${summary}" "every part that is off is named")
