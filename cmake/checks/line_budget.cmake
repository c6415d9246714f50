# Compares the number of lines that a compiler reads for every Eigen-only header with the budget, and those of a few sources as users
# write them, and fails where one exceeds it by more than 2 %. With -D UPDATE=ON it writes the budget instead.
#   cmake -D INCLUDE_DIR=<include> -D CXX=<g++> -D EIGEN_INCLUDE_DIR=<dir> -D BUDGET=<file> -D TOOLS=<text>
#         [-D UPDATE=ON] -P line_budget.cmake
# TOOLS names compiler and Eigen: line counts compare between equal tools only.
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../softtissue_headers.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/findings.cmake")

softtissue_list_headers(headers "${INCLUDE_DIR}")
softtissue_split_headers(headers headers optional "${INCLUDE_DIR}")
# A first law, a material of one's own, an avatar, everything; relative to the include folder.
list(APPEND headers ../examples/stretch_one_cell.cpp ../examples/swap_material.cpp ../tests/docs/avatar.cpp
     ../tests/consumer/main.cpp)

set(new_budget "# Lines that a compiler reads, with ${TOOLS}\n")
foreach(header IN LISTS headers)
    execute_process(
        COMMAND "${CXX}" -std=c++20 -w -E -fdirectives-only "-I${INCLUDE_DIR}" -isystem "${EIGEN_INCLUDE_DIR}" -x c++
                "${INCLUDE_DIR}/${header}"
        COMMAND wc -l
        OUTPUT_VARIABLE count OUTPUT_STRIP_TRAILING_WHITESPACE RESULTS_VARIABLE results)
    if(NOT results STREQUAL "0;0")
        message(FATAL_ERROR "${header} could not be preprocessed")
    endif()
    string(STRIP "${count}" lines_of_${header})
    string(APPEND new_budget "${header} ${lines_of_${header}}\n")
endforeach()

if(UPDATE)
    file(WRITE "${BUDGET}" "${new_budget}")
    message(STATUS "wrote ${BUDGET}")
    return()
endif()

file(STRINGS "${BUDGET}" rows)
list(POP_FRONT rows title)
if(NOT title STREQUAL "# Lines that a compiler reads, with ${TOOLS}")
    message(STATUS "skipped: '${title}', here ${TOOLS}")
    return()
endif()
set(budgeted "")
foreach(row IN LISTS rows)
    string(REPLACE " " ";" row "${row}")
    list(GET row 0 header)
    list(GET row 1 budget)
    list(APPEND budgeted ${header})
    if(NOT header IN_LIST headers)
        report("${header}: in the budget, but no such header")
        continue()
    endif()
    math(EXPR limit "${budget} + ${budget} / 50")
    if(lines_of_${header} GREATER limit)
        report("${header}: ${lines_of_${header}} lines, budget ${budget}")
    endif()
endforeach()
foreach(header IN LISTS headers)
    if(NOT header IN_LIST budgeted)
        report("${header}: not in the budget")
    endif()
endforeach()
list(LENGTH headers count)
conclude("over budget; if that is worth its price: cmake --build <dir> --target softtissue_update_budget"
         "${count} headers within the budget")
