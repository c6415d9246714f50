# Uses softtissue as a stranger's project does.
#   cmake -D KIND=find_package|add_subdirectory|pkg_config -D CXX=<compiler> -D SOURCE_DIR=<repository>
#         -D BINARY_DIR=<its build> -D WORK_DIR=<scratch> -D VERSION=<expected> -D GENERATOR=<name> -P run.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
file(MAKE_DIRECTORY "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
if(NOT KIND STREQUAL "add_subdirectory")
    # Installed elsewhere and moved: the package must not remember where it was.
    run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${WORK_DIR}/first_prefix")
    file(RENAME "${WORK_DIR}/first_prefix" "${prefix}")
endif()

if(KIND STREQUAL "pkg_config")
    set(ENV{PKG_CONFIG_PATH} "${prefix}/share/pkgconfig")
    execute_process(COMMAND pkg-config --cflags softtissue
        OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run("${CXX}" -std=c++20 ${flags} "${SOURCE_DIR}/tests/consumer/main.cpp" -o "${WORK_DIR}/consumer")
    run("${WORK_DIR}/consumer")
    return()
endif()

run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/tests/consumer/${KIND}" -B "${WORK_DIR}/build" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_PREFIX_PATH=${prefix}" "-DSOFTTISSUE_SOURCE_DIR=${SOURCE_DIR}"
    "-DEXPECTED_VERSION=${VERSION}" --no-warn-unused-cli)
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
run("${CMAKE_CTEST_COMMAND}" --test-dir "${WORK_DIR}/build" --output-on-failure --no-tests=error)
file(REMOVE_RECURSE "${WORK_DIR}")
