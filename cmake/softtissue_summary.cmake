# One summary at the end of the configuration: what is on, and which Debian package would switch on what is off.

# Notes a part of the build; `missing` lists the packages without which it is off, empty if it is on.
function(softtissue_note part missing)
    if(missing)
        list(JOIN missing " " packages)
        set_property(GLOBAL APPEND PROPERTY SOFTTISSUE_NOTES "  ${part}: OFF, needs (Debian) ${packages}")
    else()
        set_property(GLOBAL APPEND PROPERTY SOFTTISSUE_NOTES "  ${part}: on")
    endif()
endfunction()

function(softtissue_print_summary)
    message(STATUS "softtissue ${PROJECT_VERSION}, Eigen ${Eigen3_VERSION}, "
            "${CMAKE_CXX_COMPILER_ID} ${CMAKE_CXX_COMPILER_VERSION}")
    get_property(notes GLOBAL PROPERTY SOFTTISSUE_NOTES)
    foreach(note IN LISTS notes)
        message(STATUS "${note}")
    endforeach()
endfunction()
