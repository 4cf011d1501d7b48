# Precompiled headers: they save time where files are compiled one by one, as those of the tests are.
#
#   quincunx_precompile(TARGET product)    cmake/precompiled/product.h
#   quincunx_precompile(TARGET tests)      that and GoogleTest
#
# Each is compiled once, by an object library that all users share. The compiler takes it only for files with the same
# options, of which libraries have some of their own; elsewhere, and where QUINCUNX_PRECOMPILE is off, it reads the
# headers as text or not at all.
set(QUINCUNX_PRECOMPILED_FOLDER ${CMAKE_CURRENT_LIST_DIR}/precompiled)

function(quincunx_precompile target set)
  if(NOT QUINCUNX_PRECOMPILE)
    return()
  endif()
  # In every folder, because imported targets are known only where they were found.
  find_package(fmt REQUIRED QUIET)
  find_package(OpenCL REQUIRED QUIET)
  set(owner quincunx_precompiled_${set})
  get_target_property(for_library ${target} POSITION_INDEPENDENT_CODE)
  if(for_library)
    string(APPEND owner _for_libraries)
  endif()
  if(NOT TARGET ${owner})
    set(source ${PROJECT_BINARY_DIR}/precompiled/${owner}.cpp)
    file(GENERATE OUTPUT ${source} CONTENT "// Holds the precompiled header.\n")
    add_library(${owner} OBJECT ${source})
    if(for_library)
      quincunx_library(${owner})
    endif()
    target_link_libraries(${owner} PRIVATE quincunx_options fmt::fmt OpenCL::OpenCL)
    target_include_directories(${owner} PRIVATE $<TARGET_PROPERTY:quincunx,INTERFACE_INCLUDE_DIRECTORIES>)
    target_compile_definitions(${owner} PRIVATE $<TARGET_PROPERTY:quincunx,INTERFACE_COMPILE_DEFINITIONS>)
    if(set STREQUAL "tests")
      find_package(GTest REQUIRED)
      target_link_libraries(${owner} PRIVATE GTest::gtest)
    endif()
    target_precompile_headers(${owner} PRIVATE ${QUINCUNX_PRECOMPILED_FOLDER}/${set}.h)
  endif()
  # Their macros are options that have to be the same.
  target_link_libraries(${target} PRIVATE fmt::fmt)
  target_precompile_headers(${target} REUSE_FROM ${owner})
endfunction()
