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

# Those of a list of headers with a line that matches `regex`, in themselves or in what they include.
function(softtissue_headers_with list_name regex result root)
    set(found "")
    foreach(header IN LISTS ${list_name})
        file(STRINGS "${root}/${header}" lines REGEX "${regex}" LIMIT_COUNT 1)
        softtissue_included_headers(includes_of_${header} "${root}/${header}")
        if(lines)
            list(APPEND found ${header})
        endif()
    endforeach()
    # Inheritance: repeat until nothing changes.
    set(changed TRUE)
    while(changed)
        set(changed FALSE)
        foreach(header IN LISTS ${list_name})
            if(NOT header IN_LIST found)
                foreach(included IN LISTS includes_of_${header})
                    if(included IN_LIST found)
                        list(APPEND found ${header})
                        set(changed TRUE)
                        break()
                    endif()
                endforeach()
            endif()
        endforeach()
    endwhile()
    list(SORT found)
    set(${result} "${found}" PARENT_SCOPE)
endfunction()

# Splits a list of headers into those that need Eigen and the standard library only and those that need more, by
# themselves or through what they include. A header that needs more says so with a line `#if !__has_include(<...>)`;
# one that starts threads needs a thread library.
function(softtissue_split_headers list_name core_result optional_result root)
    softtissue_headers_with(${list_name} "^[ \t]*#[ \t]*(if[ \t]+!__has_include|include[ \t]*<thread>)" optional "${root}")
    set(core ${${list_name}})
    list(REMOVE_ITEM core ${optional} "")
    set(${core_result} "${core}" PARENT_SCOPE)
    set(${optional_result} "${optional}" PARENT_SCOPE)
endfunction()
