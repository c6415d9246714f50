# Checks that the umbrella includes exactly the headers below floor 7 that need Eigen only, in alphabetical order.
# With -D UPDATE=ON it rewrites the list instead.
#   cmake -D INCLUDE_DIR=<include> [-D UPDATE=ON] -P umbrella.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../softtissue_headers.cmake")

softtissue_list_headers(headers "${INCLUDE_DIR}")
softtissue_split_headers(headers expected optional "${INCLUDE_DIR}")
list(FILTER expected EXCLUDE REGEX "^softtissue/(softtissue\\.hpp|(io|model|testing)/)")

set(umbrella "${INCLUDE_DIR}/softtissue/softtissue.hpp")
if(UPDATE)
    list(TRANSFORM expected REPLACE "(.+)" "#include <\\1>\n" OUTPUT_VARIABLE includes)
    list(JOIN includes "" includes)
    file(READ "${umbrella}" text)
    string(REGEX REPLACE "#pragma once\n.*" "#pragma once\n\n${includes}" text "${text}")
    file(WRITE "${umbrella}" "${text}")
    message(STATUS "wrote ${umbrella}")
    return()
endif()

softtissue_included_headers(actual "${umbrella}")
if(NOT actual STREQUAL expected)
    set(missing ${expected})
    set(surplus ${actual})
    list(REMOVE_ITEM missing ${actual} "")
    list(REMOVE_ITEM surplus ${expected} "")
    foreach(header IN LISTS missing)
        message(NOTICE "softtissue.hpp lacks ${header}")
    endforeach()
    foreach(header IN LISTS surplus)
        message(NOTICE "softtissue.hpp should not include ${header}")
    endforeach()
    message(FATAL_ERROR "the umbrella must list every header below floor 7 that needs Eigen only, sorted; to do so:\n"
            "cmake --build <dir> --target softtissue_update_umbrella")
endif()
list(LENGTH actual count)
message(STATUS "the umbrella includes all ${count} headers that need Eigen only")
