# How the checks speak: a line for each finding, one verdict at the end.
set(failed FALSE)
function(report finding)
    message(NOTICE "${finding}")
    set(failed TRUE PARENT_SCOPE)
endfunction()

# Fails with `rule` if anything was reported, else prints `passed`.
function(conclude rule passed)
    if(failed)
        message(FATAL_ERROR "${rule}")
    endif()
    message(STATUS "${passed}")
endfunction()
