# What tests, examples and benchmarks share: warnings, the libraries that are present, ccache, and for programs that
# are timed this machine's instructions. None of it is exported.
find_package(Threads REQUIRED)

set(SOFTTISSUE_SHARED_DIR "${PROJECT_SOURCE_DIR}/../shared" CACHE PATH
    "Folder with the reference cases, bodies and motions that some tests read; those tests are skipped without it, benchmarks take the embedded body")

if(PROJECT_IS_TOP_LEVEL AND NOT DEFINED CMAKE_CXX_COMPILER_LAUNCHER)
    find_program(SOFTTISSUE_CCACHE ccache)
    mark_as_advanced(SOFTTISSUE_CCACHE)
    if(SOFTTISSUE_CCACHE)
        set(CMAKE_CXX_COMPILER_LAUNCHER "${SOFTTISSUE_CCACHE}")
    endif()
endif()

# CI compiles most tests with one compiler; tests/CMakeLists.txt says which. clang's part is most of them, and on few processors it
# takes the least time for whole programs in one go.
set(SOFTTISSUE_SHARE all CACHE STRING "Tests that are built: all, or those of one of the presets gnu, clang and sanitize")
set_property(CACHE SOFTTISSUE_SHARE PROPERTY STRINGS all gnu clang sanitize)
if(NOT SOFTTISSUE_SHARE MATCHES "^(all|gnu|clang|sanitize)$")
    message(FATAL_ERROR "SOFTTISSUE_SHARE is ${SOFTTISSUE_SHARE}, expected all, gnu, clang or sanitize")
endif()
set(SOFTTISSUE_WHOLE_PROGRAMS OFF)
if(SOFTTISSUE_SHARE STREQUAL "clang")
    set(SOFTTISSUE_WHOLE_PROGRAMS ON)
endif()
include(softtissue_group_sources)

add_library(softtissue_warnings INTERFACE)
if(CMAKE_CXX_COMPILER_ID MATCHES "GNU|Clang")
    target_compile_options(softtissue_warnings INTERFACE
        -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wsign-conversion -Wdouble-promotion -Wfloat-conversion
        -Wold-style-cast -Wnon-virtual-dtor -Woverloaded-virtual
        $<$<NOT:$<STREQUAL:$<TARGET_PROPERTY:SOFTTISSUE_MACHINE>,this>>:-Werror>)
endif()

# g++ looks for garbage often while it has little; with room for a gigabyte it takes a twelfth less time.
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    target_compile_options(softtissue_warnings INTERFACE --param=ggc-min-heapsize=1000000 --param=ggc-min-expand=200)
endif()

# The library, every component that is present (told by SOFTTISSUE_HAS_<component>), threads and the warnings.
add_library(softtissue_everything INTERFACE)
target_link_libraries(softtissue_everything INTERFACE softtissue::softtissue softtissue_warnings Threads::Threads)
foreach(component IN LISTS softtissue_COMPONENTS)
    if(softtissue_${component}_FOUND)
        string(TOUPPER ${component} upper)
        target_link_libraries(softtissue_everything INTERFACE softtissue::${component})
        target_compile_definitions(softtissue_everything INTERFACE SOFTTISSUE_HAS_${upper})
    endif()
endforeach()

# Examples, benchmarks and the unit tests of kernels use all instructions of this machine (SOFTTISSUE_NATIVE), other tests
# those of every machine. With wider vectors Eigen aligns its types otherwise, hence a program must be of one kind
# throughout: CMake refuses a target that links both softtissue_for_this_machine and softtissue_for_every_machine.
include(CheckCXXCompilerFlag)
set(native_default OFF)
if(NOT CMAKE_CROSSCOMPILING)
    check_cxx_compiler_flag(-march=native SOFTTISSUE_COMPILER_KNOWS_NATIVE)
    if(SOFTTISSUE_COMPILER_KNOWS_NATIVE)
        set(native_default ON)
    endif()
endif()
option(SOFTTISSUE_NATIVE "Compile examples, benchmarks and tests of kernels for this machine (-march=native)" ${native_default})

foreach(machine IN ITEMS this every)
    add_library(softtissue_for_${machine}_machine INTERFACE)
    target_link_libraries(softtissue_for_${machine}_machine INTERFACE softtissue_everything)
    set_target_properties(softtissue_for_${machine}_machine PROPERTIES
        COMPATIBLE_INTERFACE_STRING SOFTTISSUE_MACHINE
        INTERFACE_SOFTTISSUE_MACHINE ${machine})
endforeach()
if(SOFTTISSUE_NATIVE)
    target_compile_options(softtissue_for_this_machine INTERFACE -march=native)
    # The vector headers of some compilers (g++ 12: AVX-512) earn false warnings; which ones depends on the machine, and no
    # build stops for them. What is compiled for every machine keeps every warning as an error.
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
        target_compile_options(softtissue_for_this_machine INTERFACE
            -Wno-maybe-uninitialized -Wno-uninitialized -Wno-array-bounds)
    endif()
endif()

# What nearly every source includes is compiled once.
option(SOFTTISSUE_PRECOMPILE "Precompile the headers that tests share, and those that examples share" ON)
set(softtissue_PRECOMPILED <Eigen/Core> <algorithm> <cmath> <limits> <span> <sstream> <string> <vector>)

# What of the library compiles here: the headers, as `softtissue/...hpp`, that need Eigen only, and those that need more if
# all of it is present.
set(softtissue_USABLE_CORE_HEADERS ${core_headers})
set(softtissue_USABLE_OPTIONAL_HEADERS "")
if(softtissue_io_FOUND AND softtissue_cholmod_FOUND)
    set(softtissue_USABLE_OPTIONAL_HEADERS ${optional_headers})
    if(NOT softtissue_mpi_FOUND)
        softtissue_headers_with(SOFTTISSUE_HEADERS "^[ \t]*#[ \t]*include[ \t]*<mpi\\.h>" mpi_headers "${PROJECT_SOURCE_DIR}/include")
        list(REMOVE_ITEM softtissue_USABLE_OPTIONAL_HEADERS ${mpi_headers} "")
    endif()
endif()
