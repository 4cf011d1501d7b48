# cmake --install: libraries, headers, package configs, programs with their manuals, texts. The components are those of
# the packages (cmake/package.cmake).
#
#   find_package(quincunx REQUIRED)                          -> quincunx::quincunx, quincunx::control
#   find_package(quincunx REQUIRED COMPONENTS gl_interop)    -> quincunx::gl_interop, too
#   find_package(quincunx REQUIRED COMPONENTS record)        -> quincunx::record, too
#   find_package(quincunx REQUIRED COMPONENTS control)       -> quincunx::control alone, which needs no OpenCL
#   pkg-config quincunx, quincunx-gl, quincunx-record, quincunx-control
include(CMakePackageConfigHelpers)

set(quincunx_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/quincunx)
set(quincunx_pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# quincunx_install_library(TARGET PC name DESCRIPTION text [REQUIRES "modules"] [STATIC "modules"] [CFLAGS flags]
#                          COMPONENT lib DEV dev HEADERS folder)
# installs what programs load in the component lib, and what links them in dev, with name.pc for pkg-config: `modules`
# of it, and those that a static library leaves to its user to link. Each has an export set of its own, so that who does
# not ask for a library needs nothing of what it needs.
file(RELATIVE_PATH QUINCUNX_PC_TO_PREFIX /${quincunx_pc_dir} /)
string(REGEX REPLACE "/$" "" QUINCUNX_PC_TO_PREFIX "${QUINCUNX_PC_TO_PREFIX}")
function(quincunx_install_library target)
  cmake_parse_arguments(PARSE_ARGV 1 library "" "PC;DESCRIPTION;REQUIRES;STATIC;CFLAGS;COMPONENT;DEV;HEADERS" "")
  install(TARGETS ${target} EXPORT ${target}Targets
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${library_DEV}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${library_COMPONENT} NAMELINK_COMPONENT ${library_DEV})
  install(EXPORT ${target}Targets NAMESPACE quincunx:: DESTINATION ${quincunx_package_dir} COMPONENT ${library_DEV})
  install(DIRECTORY ${library_HEADERS}/ DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT ${library_DEV})
  if(NOT BUILD_SHARED_LIBS)
    string(APPEND library_REQUIRES " ${library_STATIC}")
    set(library_LIBS " -lstdc++ -lm -pthread")
  endif()
  configure_file(cmake/quincunx.pc.in ${library_PC}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${library_PC}.pc DESTINATION ${quincunx_pc_dir} COMPONENT ${library_DEV})
endfunction()

quincunx_install_library(quincunx_control PC quincunx-control DESCRIPTION "Resolution control of Quincunx, without OpenCL"
                         STATIC "fmt libxxhash" COMPONENT lib_control DEV dev_control HEADERS host/control/include)
quincunx_install_library(quincunx PC quincunx DESCRIPTION "${PROJECT_DESCRIPTION}" REQUIRES "quincunx-control OpenCL"
                         CFLAGS -DCL_TARGET_OPENCL_VERSION=120 COMPONENT lib DEV dev HEADERS host/include)
if(TARGET quincunx_gl)
  quincunx_install_library(quincunx_gl PC quincunx-gl DESCRIPTION "OpenGL bridge of Quincunx" REQUIRES "quincunx epoxy"
                           COMPONENT lib_gl DEV dev HEADERS gl_interop/include)
endif()
if(TARGET quincunx_record)
  quincunx_install_library(quincunx_record PC quincunx-record DESCRIPTION "Recorder of Quincunx's frames"
                           REQUIRES quincunx STATIC "OpenEXR libpng" COMPONENT lib_record DEV dev
                           HEADERS host/tools/record/include)
endif()
if(BUILD_SHARED_LIBS)  # which the Python module loads
  set(QUINCUNX_PYTHON_DIR ${CMAKE_INSTALL_DATADIR}/quincunx/python CACHE STRING "Where the Python module is installed")
  set(module ${QUINCUNX_PYTHON_DIR}/quincunx)  # a folder, for it reads the C headers
  install(FILES host/tools/python/quincunx.py RENAME __init__.py DESTINATION ${module} COMPONENT python)
  install(FILES host/include/quincunx/quincunx.h DESTINATION ${module}/include/quincunx COMPONENT python)
  install(DIRECTORY host/include/quincunx/c DESTINATION ${module}/include/quincunx COMPONENT python)
endif()

set(programs "")
foreach(program quincunx-resolve quincunx-render quincunx-dump quincunx-bench)
  if(TARGET ${program})
    list(APPEND programs ${program})
  endif()
endforeach()
if(programs)
  install(TARGETS ${programs} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT tools)
  quincunx_manuals(${programs})
endif()

configure_package_config_file(cmake/quincunxConfig.cmake.in quincunxConfig.cmake
                              INSTALL_DESTINATION ${quincunx_package_dir} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(quincunxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/quincunxConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/quincunxConfigVersion.cmake
        DESTINATION ${quincunx_package_dir} COMPONENT dev_control)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
