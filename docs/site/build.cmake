# Builds the documentation site and fails where Doxygen warns.
#   cmake -D DOXYGEN=<program> -D AWK=<program> -D ROOT=<repository> -D OUTPUT_DIR=<folder> -D VERSION=<x.y.z>
#         [-D MATHJAX_DIR=<MathJax 2, as Debian's libjs-mathjax>] -P build.cmake
cmake_minimum_required(VERSION 3.25)
include("${CMAKE_CURRENT_LIST_DIR}/../../cmake/checks/findings.cmake")

# The part of MathJax that the pages load, copied next to them: the site needs no network.
file(REMOVE_RECURSE "${OUTPUT_DIR}")
file(MAKE_DIRECTORY "${OUTPUT_DIR}/html")
if(MATHJAX_DIR)
    set(MATHJAX mathjax)
    foreach(part IN ITEMS MathJax.js extensions jax/input/TeX jax/element jax/output/SVG/jax.js jax/output/SVG/config.js
            jax/output/SVG/autoload jax/output/SVG/fonts/TeX)
        cmake_path(GET part PARENT_PATH folder)
        file(COPY "${MATHJAX_DIR}/${part}" DESTINATION "${OUTPUT_DIR}/html/mathjax/${folder}" FOLLOW_SYMLINK_CHAIN)
    endforeach()
else()
    message(STATUS "MathJax is not installed here (Debian: libjs-mathjax): formulas need the network")
    set(MATHJAX "https://cdn.jsdelivr.net/npm/mathjax@2")
endif()

configure_file("${CMAKE_CURRENT_LIST_DIR}/Doxyfile.in" "${OUTPUT_DIR}/Doxyfile" @ONLY)
execute_process(COMMAND "${DOXYGEN}" "${OUTPUT_DIR}/Doxyfile" WORKING_DIRECTORY "${OUTPUT_DIR}"
                COMMAND_ERROR_IS_FATAL ANY)

# Members of a type (or of a namespace of constants) need a comment only where their names and types do not say all.
file(READ "${OUTPUT_DIR}/warnings.txt" text)
string(REPLACE ";" "," text "${text}")
string(REPLACE "\n" ";" warnings "${text}")
foreach(warning IN LISTS warnings)
    if(warning AND NOT warning MATCHES "Member .* of (class|struct|union|namespace softtissue::).* is not documented")
        report("${warning}")
    endif()
endforeach()
file(GLOB_RECURSE pages "${OUTPUT_DIR}/html/*.html")
list(LENGTH pages count)
conclude("the documentation has errors" "${count} pages, ${OUTPUT_DIR}/html/index.html")
