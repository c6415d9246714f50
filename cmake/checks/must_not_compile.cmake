# Compiles one source and checks that it fails with the text it names, or compiles if it names success.
#   cmake -D SOURCE=<file> -D CXX=<compiler> -D INCLUDE_DIRS=<list> -P must_not_compile.cmake
cmake_minimum_required(VERSION 3.25)

file(READ "${SOURCE}" text)
if(NOT text MATCHES "// expect: ([^\n]+)\n")
    message(FATAL_ERROR "${SOURCE}: no line '// expect: <regular expression>'")
endif()
set(expected "${CMAKE_MATCH_1}")
set(flags "")
if(text MATCHES "// flags: ([^\n]+)\n")
    separate_arguments(flags UNIX_COMMAND "${CMAKE_MATCH_1}")
endif()
list(TRANSFORM INCLUDE_DIRS PREPEND -I OUTPUT_VARIABLE includes)

execute_process(COMMAND "${CXX}" -std=c++20 -fsyntax-only ${includes} ${flags} "${SOURCE}"
    RESULT_VARIABLE result OUTPUT_VARIABLE output ERROR_VARIABLE output)
if(expected STREQUAL "success")
    if(NOT result EQUAL 0)
        message(FATAL_ERROR "was expected to compile:\n${output}")
    endif()
elseif(result EQUAL 0)
    message(FATAL_ERROR "compiled, expected an error that matches '${expected}'")
elseif(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "failed, but not with '${expected}':\n${output}")
endif()
