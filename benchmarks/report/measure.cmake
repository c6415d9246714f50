# Runs benchmark programs one after the other, each with repetitions in random order, and makes a report of all of them:
#   cmake -DPROGRAMS=a,b -DREPORT=program -DFOLDER=folder -DREPETITIONS=7 -DMIN_TIME=0.1 -P measure.cmake
#
# What the baselines need to be at their best, unless the environment says otherwise: CHOLMOD starts threads that wait
# busily, OpenBLAS takes a processor that it does not know for one with SSE only, and both are compared on one thread.
cmake_minimum_required(VERSION 3.25)

if(NOT DEFINED ENV{OMP_THREAD_LIMIT})
    set(ENV{OMP_THREAD_LIMIT} 1)
endif()
if(NOT DEFINED ENV{OPENBLAS_NUM_THREADS})
    set(ENV{OPENBLAS_NUM_THREADS} 1)
endif()

# Sets OPENBLAS_CORETYPE where it is needed, and `blas` to what the program calls. OpenBLAS names the core that it takes the
# processor for as it is loaded.
function(look_for_openblas program)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E env OPENBLAS_VERBOSE=2 "${program}" --benchmark_list_tests
                    OUTPUT_VARIABLE output ERROR_VARIABLE output)
    if(NOT output MATCHES "Core: ([A-Za-z0-9]+)")
        return()
    endif()
    set(core ${CMAKE_MATCH_1})
    set(flags "")
    if(EXISTS /proc/cpuinfo)
        file(STRINGS /proc/cpuinfo flags REGEX "^flags" LIMIT_COUNT 1)
    endif()
    if(NOT DEFINED ENV{OPENBLAS_CORETYPE} AND core MATCHES "^(Prescott|Generic|Core2|Katmai|Northwood)$")
        if(flags MATCHES " avx512dq ")
            set(core SKYLAKEX)
        elseif(flags MATCHES " avx2 ")
            set(core HASWELL)
        endif()
        set(ENV{OPENBLAS_CORETYPE} ${core})
    endif()
    set(blas "OpenBLAS for ${core}" PARENT_SCOPE)
endfunction()

set(blas "not OpenBLAS, with which CHOLMOD's supernodal factorisations would be several times as fast")
string(REPLACE "," ";" PROGRAMS "${PROGRAMS}")
file(REMOVE_RECURSE "${FOLDER}")
file(MAKE_DIRECTORY "${FOLDER}")
foreach(program IN LISTS PROGRAMS)
    cmake_path(GET program STEM name)
    string(REPLACE softtissue_benchmark_ "" name "${name}")
    message(STATUS "${name}")
    look_for_openblas("${program}")
    execute_process(
        COMMAND "${program}" --benchmark_repetitions=${REPETITIONS} --benchmark_min_time=${MIN_TIME}
            --benchmark_enable_random_interleaving=true --benchmark_display_aggregates_only=true
            "--benchmark_out=${FOLDER}/${name}.json" --benchmark_out_format=json
        OUTPUT_FILE "${FOLDER}/${name}.txt" ERROR_VARIABLE error RESULT_VARIABLE failed)
    if(failed)
        message(FATAL_ERROR "${name}: ${failed}\n${error}")
    endif()
endforeach()

set(processor "an unknown processor")
if(EXISTS /proc/cpuinfo)
    file(STRINGS /proc/cpuinfo model REGEX "^model name" LIMIT_COUNT 1)
    string(REGEX REPLACE "^[^:]*: *" "" processor "${model}")
endif()
string(TIMESTAMP today "%d %B %Y")
file(WRITE "${FOLDER}/machine.md" "${today}, ${processor}, ${COMPILER}, ${REPETITIONS} repetitions. BLAS: ${blas}.\n")
execute_process(COMMAND "${REPORT}" "${FOLDER}" RESULT_VARIABLE failed)
if(failed)
    message(FATAL_ERROR "no report")
endif()
