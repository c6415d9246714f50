# Installs what the lock file names (once) and bundles the template. Where that fails, without a network for example, it
# says so and the build goes on: the programs then write everything but their page, and the next build tries again.
#
#   cmake -DNODE=... -DNPM=... -DWITH_TESTS=ON|OFF -DPACKAGES=folder -DTEMPLATE=file -P make_template.cmake
set(here "${CMAKE_CURRENT_LIST_DIR}")

function(run_step what)
    cmake_parse_arguments(PARSE_ARGV 1 step "" "FOLDER" "COMMAND")
    execute_process(COMMAND ${step_COMMAND} WORKING_DIRECTORY "${step_FOLDER}" RESULT_VARIABLE status
                    OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT status EQUAL 0)
        file(REMOVE "${TEMPLATE}")
        message(WARNING "no report.html: ${what} failed (${status})\n${output}")
    endif()
    set(status "${status}" PARENT_SCOPE)
endfunction()

set(state "${WITH_TESTS}")
file(SHA256 "${here}/package-lock.json" lock)
string(APPEND state " ${lock}")
set(installed "")
if(EXISTS "${PACKAGES}/installed.txt")
    file(READ "${PACKAGES}/installed.txt" installed)
endif()
if(NOT installed STREQUAL state)
    file(REMOVE "${PACKAGES}/installed.txt")
    file(COPY "${here}/package.json" "${here}/package-lock.json" DESTINATION "${PACKAGES}")
    set(omit --omit=dev)
    if(WITH_TESTS)
        set(omit "")
    endif()
    run_step("npm ci" FOLDER "${PACKAGES}" COMMAND "${NPM}" ci --ignore-scripts --no-audit --no-fund --fetch-retries=1
             --fetch-retry-mintimeout=1000 ${omit})
    if(NOT status EQUAL 0)
        return()
    endif()
    file(WRITE "${PACKAGES}/installed.txt" "${state}")
endif()
run_step("the bundle" FOLDER "${here}" COMMAND "${NODE}" build.mjs "${PACKAGES}" "${TEMPLATE}")
