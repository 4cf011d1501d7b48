# What the libraries of the project have in common, static or shared.
#
#   quincunx_library(TARGET)             hidden symbols but those that QUINCUNX_API marks; fit for a shared library
#   quincunx_shared_library(TARGET)      the version of a shared one; done by quincunx_library() where it is one
#
# The number after .so rises when a program that was linked against the library would have to be built anew. The C
# interface grows without that (docs/integrate.md); the classes of C++ do not.
set(QUINCUNX_ABI_VERSION 1)
set(QUINCUNX_EXPORTS ${CMAKE_CURRENT_LIST_DIR}/exports.map)

function(quincunx_shared_library target)
  set_target_properties(${target} PROPERTIES
    SOVERSION ${QUINCUNX_ABI_VERSION} VERSION ${QUINCUNX_ABI_VERSION}.${PROJECT_VERSION}
    LINK_DEPENDS ${QUINCUNX_EXPORTS})
  target_link_options(${target} PRIVATE LINKER:--version-script=${QUINCUNX_EXPORTS})
  if(NOT QUINCUNX_SANITIZE)  # whose functions some compilers leave to the program
    target_link_options(${target} PRIVATE LINKER:--no-undefined)
  endif()
endfunction()

function(quincunx_library target)
  set_target_properties(${target} PROPERTIES
    POSITION_INDEPENDENT_CODE ON C_VISIBILITY_PRESET hidden CXX_VISIBILITY_PRESET hidden
    VISIBILITY_INLINES_HIDDEN ON DEFINE_SYMBOL "")
  get_target_property(type ${target} TYPE)
  if(type STREQUAL "SHARED_LIBRARY")
    quincunx_shared_library(${target})
  endif()
endfunction()
