# Uses softtissue as a stranger's project does.
#   cmake -D KIND=find_package|add_subdirectory|pkg_config|debian_package|fetch_content -D CXX=<compiler>
#         -D SOURCE_DIR=<repository> -D BINARY_DIR=<its build> -D WORK_DIR=<scratch> -D VERSION=<expected>
#         -D GENERATOR=<name> -P run.cmake
cmake_minimum_required(VERSION 3.25)

function(run)
    execute_process(COMMAND ${ARGV} COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE "${WORK_DIR}")
file(MAKE_DIRECTORY "${WORK_DIR}")
set(prefix "${WORK_DIR}/prefix")
set(project ${KIND})
if(KIND STREQUAL "find_package" OR KIND STREQUAL "pkg_config")
    # Installed elsewhere and moved: the package must not remember where it was.
    run("${CMAKE_COMMAND}" --install "${BINARY_DIR}" --prefix "${WORK_DIR}/first_prefix")
    file(RENAME "${WORK_DIR}/first_prefix" "${prefix}")
elseif(KIND STREQUAL "debian_package")
    # Made as a packager makes it, from a build without tests, and unpacked into a folder of its own.
    run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}" -B "${WORK_DIR}/package" -G "${GENERATOR}" "-DCMAKE_CXX_COMPILER=${CXX}"
        -DSOFTTISSUE_BUILD_TESTS=OFF -DSOFTTISSUE_BUILD_EXAMPLES=OFF)
    run("${CMAKE_CPACK_COMMAND}" --config "${WORK_DIR}/package/CPackConfig.cmake" -B "${WORK_DIR}/deb")
    set(package "${WORK_DIR}/deb/libsofttissue-dev_${VERSION}_all.deb")
    run(dpkg-deb -x "${package}" "${WORK_DIR}/root")
    execute_process(COMMAND dpkg-deb -f "${package}" Package Version Architecture Depends
        OUTPUT_VARIABLE fields COMMAND_ERROR_IS_FATAL ANY)
    set(expected "Package: libsofttissue-dev\nVersion: ${VERSION}\nArchitecture: all\nDepends: libeigen3-dev (>= 3.4)\n")
    if(NOT fields STREQUAL expected)
        message(FATAL_ERROR "the package says:\n${fields}expected:\n${expected}")
    endif()
    file(GLOB_RECURSE packed RELATIVE "${WORK_DIR}/root/usr/include" "${WORK_DIR}/root/usr/include/*.hpp")
    file(GLOB_RECURSE headers RELATIVE "${SOURCE_DIR}/include" "${SOURCE_DIR}/include/*.hpp")
    if(NOT packed STREQUAL headers)
        message(FATAL_ERROR "the package lacks headers, or has others")
    endif()
    set(prefix "${WORK_DIR}/root/usr")
    set(project quick_start)
elseif(KIND STREQUAL "fetch_content")
    # A repository with what this tree holds now.
    set(repository "${WORK_DIR}/repository")
    foreach(part IN ITEMS CMakeLists.txt LICENSE cmake include)
        file(COPY "${SOURCE_DIR}/${part}" DESTINATION "${repository}")
    endforeach()
    run(git -C "${repository}" init -q -b main)
    run(git -C "${repository}" add .)
    run(git -C "${repository}" -c user.name=consumer -c user.email=consumer@localhost commit -q -m "Copy")
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

run("${CMAKE_COMMAND}" -S "${SOURCE_DIR}/tests/consumer/${project}" -B "${WORK_DIR}/build" -G "${GENERATOR}"
    "-DCMAKE_CXX_COMPILER=${CXX}" "-DCMAKE_PREFIX_PATH=${prefix}" "-DSOFTTISSUE_SOURCE_DIR=${SOURCE_DIR}"
    "-DSOFTTISSUE_REPOSITORY=${repository}" "-DEXPECTED_VERSION=${VERSION}" --no-warn-unused-cli)
run("${CMAKE_COMMAND}" --build "${WORK_DIR}/build")
run("${CMAKE_CTEST_COMMAND}" --test-dir "${WORK_DIR}/build" --output-on-failure --no-tests=error)
file(REMOVE_RECURSE "${WORK_DIR}")
