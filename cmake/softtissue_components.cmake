# The optional components. The same file serves the source tree and the installed package: a component of a
# header-only library is only a list of libraries to link, so it is made where it is used.
#
#   io        softtissue::io        npz and glTF files, with JSON for reports
#   cholmod   softtissue::cholmod   SuiteSparse's sparse Cholesky factorisation
#   mpi       softtissue::mpi       work shared between processes, on one machine or several

# Per library: name, header, where to look for it, library to link (or -), Debian package.
set(softtissue_io_LIBRARIES
    "libzip|zip.h||zip|libzip-dev"
    "tinygltf|tiny_gltf.h||tinygltf|libtinygltf-dev"
    "nlohmann_json|nlohmann/json.hpp||-|nlohmann-json3-dev")
set(softtissue_cholmod_LIBRARIES
    "cholmod|cholmod.h|suitesparse|cholmod|libsuitesparse-dev")
set(softtissue_mpi_LIBRARIES
    "mpi|mpi.h|mpi|mpi|libopenmpi-dev")

# Makes softtissue::<component> if all its libraries are found. Sets softtissue_<component>_FOUND and
# softtissue_<component>_MISSING, the Debian packages that hold what was not found. Plain searches, because the
# package configurations of several of these libraries ask for files of further packages.
macro(softtissue_add_component component)
    set(softtissue_${component}_MISSING "")
    set(softtissue_found_includes "")
    set(softtissue_found_libraries "")
    foreach(softtissue_row IN LISTS softtissue_${component}_LIBRARIES)
        string(REPLACE "|" ";" softtissue_row "${softtissue_row}")
        list(GET softtissue_row 0 softtissue_name)
        list(GET softtissue_row 1 softtissue_header)
        list(GET softtissue_row 2 softtissue_suffix)
        list(GET softtissue_row 3 softtissue_library)
        list(GET softtissue_row 4 softtissue_package)
        find_path(SOFTTISSUE_${softtissue_name}_INCLUDE_DIR ${softtissue_header} PATH_SUFFIXES ${softtissue_suffix})
        mark_as_advanced(SOFTTISSUE_${softtissue_name}_INCLUDE_DIR)
        set(softtissue_is_found ${SOFTTISSUE_${softtissue_name}_INCLUDE_DIR})
        list(APPEND softtissue_found_includes ${SOFTTISSUE_${softtissue_name}_INCLUDE_DIR})
        if(NOT softtissue_library STREQUAL "-")
            find_library(SOFTTISSUE_${softtissue_name}_LIBRARY ${softtissue_library})
            mark_as_advanced(SOFTTISSUE_${softtissue_name}_LIBRARY)
            if(NOT SOFTTISSUE_${softtissue_name}_LIBRARY)
                set(softtissue_is_found FALSE)
            endif()
            list(APPEND softtissue_found_libraries ${SOFTTISSUE_${softtissue_name}_LIBRARY})
        endif()
        if(NOT softtissue_is_found)
            list(APPEND softtissue_${component}_MISSING ${softtissue_package})
        endif()
    endforeach()

    if(softtissue_${component}_MISSING)
        set(softtissue_${component}_FOUND FALSE)
    else()
        set(softtissue_${component}_FOUND TRUE)
        if(NOT TARGET softtissue::${component})
            list(REMOVE_DUPLICATES softtissue_found_includes)
            add_library(softtissue::${component} INTERFACE IMPORTED)
            # In the source tree the projects that add it as a subdirectory see the component too.
            if(NOT CMAKE_FIND_PACKAGE_NAME STREQUAL "softtissue")
                set_target_properties(softtissue::${component} PROPERTIES IMPORTED_GLOBAL TRUE)
            endif()
            target_include_directories(softtissue::${component} SYSTEM INTERFACE ${softtissue_found_includes})
            target_link_libraries(softtissue::${component} INTERFACE softtissue::softtissue
                                  ${softtissue_found_libraries})
        endif()
    endif()
endmacro()
