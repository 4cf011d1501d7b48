# cmake --install: libraries, headers, package configs, programs with their manuals, texts. The components are those of
# the packages (cmake/package.cmake).
#
#   find_package(quincunx REQUIRED)                          -> quincunx::quincunx
#   find_package(quincunx REQUIRED COMPONENTS gl_interop)    -> quincunx::gl_interop, too
#   find_package(quincunx REQUIRED COMPONENTS record)        -> quincunx::record, too
#   pkg-config quincunx, quincunx-gl, quincunx-record
include(CMakePackageConfigHelpers)

set(quincunx_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/quincunx)
set(quincunx_pc_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

# quincunx_install_library(TARGET COMPONENT EXPORT): what programs load, in its own package; what links them, in dev.
function(quincunx_install_library target component export)
  install(TARGETS ${target} EXPORT ${export}
          ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT dev
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT ${component} NAMELINK_COMPONENT dev)
  install(EXPORT ${export} NAMESPACE quincunx:: DESTINATION ${quincunx_package_dir} COMPONENT dev)
endfunction()

# quincunx_install_pc(NAME): NAME.pc for pkg-config.
function(quincunx_install_pc name)
  file(RELATIVE_PATH QUINCUNX_PC_TO_PREFIX /${quincunx_pc_dir} /)
  string(REGEX REPLACE "/$" "" QUINCUNX_PC_TO_PREFIX "${QUINCUNX_PC_TO_PREFIX}")
  if(NOT BUILD_SHARED_LIBS)  # what a static library leaves to its user to link
    set(QUINCUNX_PC_REQUIRES " fmt libxxhash")
    set(QUINCUNX_PC_LIBS " -lstdc++ -lm -pthread")
    set(QUINCUNX_PC_RECORD_REQUIRES " OpenEXR libpng")
  endif()
  configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${quincunx_pc_dir} COMPONENT dev)
endfunction()

quincunx_install_library(quincunx lib quincunxTargets)
quincunx_install_pc(quincunx)
install(DIRECTORY host/include/quincunx host/control/include/quincunx DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
if(BUILD_SHARED_LIBS)  # which the Python module loads
  set(QUINCUNX_PYTHON_DIR ${CMAKE_INSTALL_DATADIR}/quincunx/python CACHE STRING "Where the Python module is installed")
  set(module ${QUINCUNX_PYTHON_DIR}/quincunx)  # a folder, for it reads the C headers
  install(FILES host/tools/python/quincunx.py RENAME __init__.py DESTINATION ${module} COMPONENT python)
  install(FILES host/include/quincunx/quincunx.h DESTINATION ${module}/include/quincunx COMPONENT python)
  install(DIRECTORY host/include/quincunx/c DESTINATION ${module}/include/quincunx COMPONENT python)
endif()

# An export set of its own: who does not ask for the bridge needs no epoxy.
if(TARGET quincunx_gl)
  quincunx_install_library(quincunx_gl lib_gl quincunx_gl_interopTargets)
  quincunx_install_pc(quincunx-gl)
  install(DIRECTORY gl_interop/include/quincunx_gl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
endif()

if(TARGET quincunx_record)
  quincunx_install_library(quincunx_record lib_record quincunx_recordTargets)
  quincunx_install_pc(quincunx-record)
  install(DIRECTORY host/tools/record/include/quincunx_record DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} COMPONENT dev)
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
        DESTINATION ${quincunx_package_dir} COMPONENT dev)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT licence)
install(FILES README.md DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
install(DIRECTORY docs DESTINATION ${CMAKE_INSTALL_DOCDIR} COMPONENT doc)
