# Proves that the checks of headers catch what they are there for: each runs on a small wrong tree.
#   cmake -D WORK_DIR=<empty folder> -P self_test.cmake
cmake_minimum_required(VERSION 3.25)

set(good "// SPDX-License-Identifier: MIT\n/// @file\n/// A header.\n#pragma once\n")

# expect(<check> <text of the failure> [<header> <lines>]...) writes the headers and runs the check on them.
function(expect check text)
    file(REMOVE_RECURSE "${WORK_DIR}")
    set(files ${ARGN})
    while(files)
        list(POP_FRONT files header lines)
        file(WRITE "${WORK_DIR}/include/softtissue/${header}" "${lines}\n")
    endwhile()
    execute_process(
        COMMAND "${CMAKE_COMMAND}" "-DROOT=${WORK_DIR}" "-DINCLUDE_DIR=${WORK_DIR}/include"
                -DPAGES=page.md -P "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/${check}.cmake"
        RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
    string(FIND "${output}" "${text}" position)
    if(result EQUAL 0 OR position EQUAL -1)
        message(FATAL_ERROR "${check} was expected to fail with\n  ${text}\nbut ended with ${result} and said\n${output}")
    endif()
    message(STATUS "${check} catches: ${text}")
endfunction()

expect(layers "softtissue/core/up.hpp (floor 0) includes softtissue/linalg/svd.hpp (floor 1)"
    core/up.hpp "${good}#include <softtissue/linalg/svd.hpp>" linalg/svd.hpp "${good}")
expect(layers "softtissue/element/side.hpp (floor 2) includes softtissue/material/arap.hpp (floor 2)"
    element/side.hpp "${good}#  include <softtissue/material/arap.hpp>" material/arap.hpp "${good}")
expect(layers "softtissue/anatomy/in.hpp (floor 6) includes softtissue/avatar/a.hpp (floor 6)"
    anatomy/in.hpp "${good}#include <softtissue/avatar/a.hpp>" avatar/a.hpp "${good}#include <softtissue/anatomy/in.hpp>")
expect(layers "folder 'misc' has no floor" misc/thing.hpp "${good}")
expect(layers "which does not exist" core/lost.hpp "${good}#include <softtissue/core/gone.hpp>")

expect(header_form "does not begin with the licence line" core/a.hpp "#pragma once")
expect(header_form "no #pragma once" core/a.hpp "// SPDX-License-Identifier: MIT\n/// @file\n/// A header.\n")
expect(header_form "includes <Eigen/Dense>" core/a.hpp "${good}#include <Eigen/Dense>")
expect(header_form "allowed in testing/ only" core/a.hpp "${good}#include <random>")
expect(header_form "includes with quotes" core/a.hpp "${good}#include \"b.hpp\"")
string(REPEAT "\n" 300 empty_lines)
expect(header_form "lines, expected at most 300" core/a.hpp "${good}${empty_lines}")

expect(header_tests "softtissue/core/a.hpp: no tests/unit/core/a_test.cpp" core/a.hpp "${good}")
expect(header_tests "names tests/laws/gone_test.cpp" core/concepts.hpp "${good}/// tests/laws/gone_test.cpp")

expect(umbrella "softtissue.hpp lacks softtissue/core/a.hpp" core/a.hpp "${good}" softtissue.hpp "${good}")
expect(umbrella "softtissue.hpp should not include softtissue/core/b.hpp" core/a.hpp "${good}#include <softtissue/core/b.hpp>"
    core/b.hpp "${good}#if !__has_include(<zip.h>)\n#endif"
    softtissue.hpp "${good}#include <softtissue/core/b.hpp>")

# Pages, above the include folder.
expect(doc_blocks "neither a program with its output nor a fragment" ../../page.md "```cpp\nint x = 1\n```\n\nText.\n\n```text\n1\n```")
expect(doc_blocks "this is not in core.cpp" ../../page.md "<!-- from core.cpp -->\n```cpp\nint y\n```" ../../core.cpp "int x")
expect(doc_blocks "this is not in core.cpp" ../../page.md "<!-- from core.cpp -->\n```cpp\nint y\n// ...\nint x\n```"
    ../../core.cpp "int x, z, int y")
expect(doc_blocks "a fragment of gone.cpp" ../../page.md "<!-- from gone.cpp -->\n```cpp\nint y\n```")
expect(doc_blocks "no program gone" ../../page.md "```sh\ncmake --build build && build/gone --out x  # a remark\n```")
expect(doc_blocks "no script gone.sh" ../../page.md "```sh\nsh gone.sh\n```")
expect(doc_blocks "a link to gone.md" ../../page.md "```sh\ncd x\n```\n[Gone](gone.md)")

file(REMOVE_RECURSE "${WORK_DIR}")
