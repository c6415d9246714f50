# What tests, examples and benchmarks share: warnings, the libraries that are present, ccache. None of it is exported.
find_package(Threads REQUIRED)

if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(SOFTTISSUE_CCACHE ccache)
    mark_as_advanced(SOFTTISSUE_CCACHE)
    if(SOFTTISSUE_CCACHE)
        set(CMAKE_CXX_COMPILER_LAUNCHER "${SOFTTISSUE_CCACHE}")
    endif()
endif()

add_library(softtissue_warnings INTERFACE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(softtissue_warnings INTERFACE
        -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wfloat-conversion
        -Wold-style-cast -Wnon-virtual-dtor -Woverloaded-virtual -Werror)
endif()

# The library, every component that is present (told by SOFTTISSUE_HAS_<component>), threads and the warnings.
add_library(softtissue_everything INTERFACE)
target_link_libraries(softtissue_everything INTERFACE softtissue::softtissue softtissue_warnings Threads::Threads)
foreach(component IN ITEMS io cholmod)
    if(softtissue_${component}_FOUND)
        string(TOUPPER ${component} upper)
        target_link_libraries(softtissue_everything INTERFACE softtissue::${component})
        target_compile_definitions(softtissue_everything INTERFACE SOFTTISSUE_HAS_${upper})
    endif()
endforeach()
