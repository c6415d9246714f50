# Checks that every header has a unit test of the same path, and that the tests a header names exist.
#   cmake -D ROOT=<repository> -P header_tests.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../softtissue_headers.cmake")
include("${CMAKE_CURRENT_LIST_DIR}/findings.cmake")

# The umbrella, and the concepts: their assertions, both ways, stand in the tests of the types that model them.
set(exceptions "^softtissue/(softtissue|[a-z]+/concepts)\\.hpp$")

softtissue_list_headers(headers "${ROOT}/include")
foreach(header IN LISTS headers)
    string(REGEX REPLACE "^softtissue/(.*)\\.hpp$" "tests/unit/\\1_test.cpp" test "${header}")
    if(NOT header MATCHES "${exceptions}" AND NOT EXISTS "${ROOT}/${test}")
        report("${header}: no ${test}")
    endif()
    file(READ "${ROOT}/include/${header}" text)
    string(REGEX MATCHALL "tests/[a-z0-9_/]+\\.cpp" named_tests "${text}")
    list(REMOVE_DUPLICATES named_tests)
    foreach(named IN LISTS named_tests)
        if(NOT named STREQUAL test AND NOT EXISTS "${ROOT}/${named}")
            report("${header}: names ${named}, which does not exist")
        endif()
    endforeach()
endforeach()

list(LENGTH headers count)
conclude("every header has a test, and names no other" "${count} headers have their tests")
