# The version, read from the one place where it is written.
set(softtissue_VERSION_IN_HEADER "")
foreach(part IN ITEMS MAJOR MINOR PATCH)
    file(STRINGS "${CMAKE_CURRENT_LIST_DIR}/../include/softtissue/core/version.hpp" line
         REGEX "^#define SOFTTISSUE_VERSION_${part} [0-9]+")
    string(REGEX REPLACE "^#define [A-Z_]+ ([0-9]+).*$" "\\1" number "${line}")
    list(APPEND softtissue_VERSION_IN_HEADER ${number})
endforeach()
list(JOIN softtissue_VERSION_IN_HEADER "." softtissue_VERSION_IN_HEADER)
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS "${CMAKE_CURRENT_LIST_DIR}/../include/softtissue/core/version.hpp")
