# cmake --install: library, headers, package config and programs.
#
#   find_package(quincunx REQUIRED)                          -> quincunx::quincunx
#   find_package(quincunx REQUIRED COMPONENTS gl_interop)    -> quincunx::gl_interop, too
include(CMakePackageConfigHelpers)

set(quincunx_package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/quincunx)

install(TARGETS quincunx EXPORT quincunxTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
install(DIRECTORY host/include/quincunx DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT quincunxTargets NAMESPACE quincunx:: DESTINATION ${quincunx_package_dir})

if(BUILD_SHARED_LIBS)  # which the Python module loads
  set(QUINCUNX_PYTHON_DIR ${CMAKE_INSTALL_DATADIR}/quincunx/python CACHE STRING "Where quincunx.py is installed")
  install(FILES host/tools/python/quincunx.py DESTINATION ${QUINCUNX_PYTHON_DIR})
endif()

# An export set of its own: who does not ask for the bridge needs neither EGL nor epoxy.
if(TARGET quincunx_gl)
  install(TARGETS quincunx_gl EXPORT quincunx_gl_interopTargets ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR}
          LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY gl_interop/include/quincunx_gl DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT quincunx_gl_interopTargets NAMESPACE quincunx:: DESTINATION ${quincunx_package_dir})
endif()
if(TARGET quincunx-resolve)
  install(TARGETS quincunx-resolve RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()
if(TARGET quincunx-render)
  install(TARGETS quincunx-render quincunx-dump quincunx-bench RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
endif()

configure_package_config_file(cmake/quincunxConfig.cmake.in quincunxConfig.cmake
                              INSTALL_DESTINATION ${quincunx_package_dir} NO_SET_AND_CHECK_MACRO)
# Before 1.0 a minor version may change the interface.
write_basic_package_version_file(quincunxConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/quincunxConfig.cmake ${CMAKE_CURRENT_BINARY_DIR}/quincunxConfigVersion.cmake
        DESTINATION ${quincunx_package_dir})
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
