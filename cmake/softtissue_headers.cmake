# What the build and the header checks know about the library's headers. Works in projects and in scripts.

# Every header below `root`, relative to it, sorted.
function(softtissue_list_headers result root)
    set(depends "")
    if(NOT CMAKE_SCRIPT_MODE_FILE)
        set(depends CONFIGURE_DEPENDS)
    endif()
    file(GLOB_RECURSE headers RELATIVE "${root}" ${depends} "${root}/softtissue/*.hpp")
    list(SORT headers)
    set(${result} "${headers}" PARENT_SCOPE)
endfunction()

# The library's own headers that `file` includes, as written between the angle brackets.
function(softtissue_included_headers result file)
    file(STRINGS "${file}" lines REGEX "^[ \t]*#[ \t]*include[ \t]*<softtissue/[^>]+>")
    list(TRANSFORM lines REPLACE "^[^<]*<([^>]+)>.*$" "\\1")
    set(${result} "${lines}" PARENT_SCOPE)
endfunction()

# Splits a list of headers into those that need Eigen and the standard library only and those that need more, by
# themselves or through what they include. A header that needs more says so with a line `#if !__has_include(<...>)`;
# one that starts threads needs a thread library.
function(softtissue_split_headers list_name core_result optional_result root)
    set(optional "")
    foreach(header IN LISTS ${list_name})
        file(STRINGS "${root}/${header}" needs
             REGEX "^[ \t]*#[ \t]*(if[ \t]+!__has_include|include[ \t]*<thread>)")
        softtissue_included_headers(includes_of_${header} "${root}/${header}")
        if(needs)
            list(APPEND optional ${header})
        endif()
    endforeach()
    # Inheritance of the need: repeat until nothing changes.
    set(changed TRUE)
    while(changed)
        set(changed FALSE)
        foreach(header IN LISTS ${list_name})
            if(NOT header IN_LIST optional)
                foreach(included IN LISTS includes_of_${header})
                    if(included IN_LIST optional)
                        list(APPEND optional ${header})
                        set(changed TRUE)
                        break()
                    endif()
                endforeach()
            endif()
        endforeach()
    endwhile()
    set(core ${${list_name}})
    if(optional)
        list(REMOVE_ITEM core ${optional})
        list(SORT optional)
    endif()
    set(${core_result} "${core}" PARENT_SCOPE)
    set(${optional_result} "${optional}" PARENT_SCOPE)
endfunction()
