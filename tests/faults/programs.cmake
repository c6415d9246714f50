# Programs under faults from outside: results that were there stay as they were, the exit code is 1 and the message says why
# and what to do; the next run goes on.
#   cmake -D PROGRAMS=<folder of the examples> -D WORK_DIR=<scratch> -P programs.cmake
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE "${WORK_DIR}")
file(MAKE_DIRECTORY "${WORK_DIR}")
set(num_faults 0)

# Names and content of all files below the scratch folder.
function(read_state result)
    file(GLOB_RECURSE files RELATIVE "${WORK_DIR}" "${WORK_DIR}/*")
    set(state "")
    foreach(file IN LISTS files)
        file(SHA256 "${WORK_DIR}/${file}" hash)
        list(APPEND state "${file} ${hash}")
    endforeach()
    set(${result} "${state}" PARENT_SCOPE)
endfunction()

# Runs a line of shell in the scratch folder, where $P is the folder of the programs.
function(shell line)
    execute_process(COMMAND "${CMAKE_COMMAND}" -E env "P=${PROGRAMS}" sh -c "${line}"
        WORKING_DIRECTORY "${WORK_DIR}" RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE errors)
    set(code "${code}" PARENT_SCOPE)
    set(errors "${errors}" PARENT_SCOPE)
endfunction()

function(must_run line)
    shell("${line}")
    if(NOT code EQUAL 0)
        message(FATAL_ERROR "${line}\nended with ${code}:\n${errors}")
    endif()
endfunction()

# The line must end with exit code 1, say something that contains `text` and leave every file as it was.
macro(must_fail text line)
    read_state(before)
    shell("${line}")
    read_state(after)
    string(FIND "${errors}" "${text}" place)
    if(NOT code EQUAL 1 OR place EQUAL -1 OR NOT after STREQUAL before)
        message(FATAL_ERROR "${line}\nended with ${code}, expected 1 and '${text}':\n${errors}\nbefore: ${before}\nafter: ${after}")
    endif()
    math(EXPR num_faults "${num_faults} + 1")
endmacro()

set(program "\"$P\"/compare_skinning --out results")
must_run("${program}")
set(full_disk "cannot write: File too large; allow larger files (ulimit -f) and write again")
foreach(blocks IN ITEMS 0 200)
    must_fail("${full_disk}" "trap '' XFSZ; ulimit -f ${blocks}; exec ${program}")
endforeach()
must_fail("out of memory; files that are there are complete" "ulimit -v 60000; exec ${program}")
must_fail("cannot write: Not a directory" "exec ${program}/report.html")
must_fail("cannot write, expected the name of a file, not of a folder or device"
    "exec \"$P\"/retarget_motion --out /dev/null")
if(EXISTS /dev/full)
    must_fail("cannot print: No space left on device; the files are complete" "exec ${program} > /dev/full")
endif()
find_program(FLOCK flock)
if(FLOCK)
    must_fail("results: another program writes its results there; wait for its end, or choose another folder"
        "exec \"${FLOCK}\" results ${program}")
endif()

# Ended by a signal in the middle of a file: what is left does not disturb the next run, and is gone after it.
read_state(before)
shell("ulimit -f 16; exec ${program}")
read_state(after)
list(FILTER after EXCLUDE REGEX "\\.part0 ")
if(code EQUAL 0 OR NOT after STREQUAL before)
    message(FATAL_ERROR "killed with ${code}:\n${errors}\nbefore: ${before}\nafter: ${after}")
endif()
must_run("${program}")
read_state(after)
if(NOT after STREQUAL before)
    message(FATAL_ERROR "after a killed run:\nbefore: ${before}\nafter: ${after}")
endif()
message(STATUS "${num_faults} faults and a kill: results as before, each told")
file(REMOVE_RECURSE "${WORK_DIR}")
