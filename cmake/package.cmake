# cpack: Debian packages of what --install installs, one for each component. For a tree that was configured with the
# preset `package`: shared libraries, prefix /usr. scripts/try_packages.sh makes and tries them in bare systems.
#
# DEBFULLNAME and DEBEMAIL say who made them, as for other Debian tools.
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME quincunx)
set(CPACK_PACKAGE_VENDOR Quincunx)
# CPack's own, which it leaves out; so the first line of each package's text is its summary.
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "${PROJECT_NAME} built using CMake")
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "Unnamed packager <packager@localhost>")
if(DEFINED ENV{DEBEMAIL})
  set(name "$ENV{DEBFULLNAME}")
  if(NOT name)
    set(name "Quincunx packager")
  endif()
  set(CPACK_PACKAGE_CONTACT "${name} <$ENV{DEBEMAIL}>")
endif()
set(CPACK_PACKAGING_INSTALL_PREFIX ${CMAKE_INSTALL_PREFIX})
set(CPACK_STRIP_FILES ON)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_PRIORITY optional)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS_PRIVATE_DIRS ${PROJECT_BINARY_DIR}/host ${PROJECT_BINARY_DIR}/host/control
                                            ${PROJECT_BINARY_DIR}/gl_interop)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(suite unknown)
if(EXISTS /etc/os-release)  # packages of two releases of Debian differ in what they depend on
  file(STRINGS /etc/os-release suite REGEX "^VERSION_ID=")
  string(REGEX REPLACE "^VERSION_ID=\"?([^\"]*)\"?$" "\\1" suite "${suite}")
endif()
set(CPACK_DEBIAN_PACKAGE_RELEASE 1~deb${suite})
set(exactly "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
string(TIMESTAMP quincunx_date "%a, %d %b %Y %H:%M:%S +0000" UTC)

# The licence as copyright files have it: indented, with a dot for an empty line.
file(READ LICENSE QUINCUNX_LICENCE_TEXT)
string(REGEX MATCH "Copyright \\(c\\) ([^\n]*)" line "${QUINCUNX_LICENCE_TEXT}")
set(QUINCUNX_COPYRIGHT "${CMAKE_MATCH_1}")
string(REGEX REPLACE "^.*Copyright[^\n]*\n\n" "" QUINCUNX_LICENCE_TEXT "${QUINCUNX_LICENCE_TEXT}")
string(STRIP "${QUINCUNX_LICENCE_TEXT}" QUINCUNX_LICENCE_TEXT)
string(REPLACE "\n\n" "\n.\n" QUINCUNX_LICENCE_TEXT "${QUINCUNX_LICENCE_TEXT}")
string(REPLACE "\n" "\n " QUINCUNX_LICENCE_TEXT " ${QUINCUNX_LICENCE_TEXT}")

# quincunx_package(COMPONENT NAME SECTION SUMMARY TEXT [DEPENDS ...] [RECOMMENDS ...] [LIBRARY libNAME] [ALL])
# LIBRARY: the shared library in it; ALL: for every processor.
macro(quincunx_package component name section summary text)
  cmake_parse_arguments(package "ALL" "DEPENDS;RECOMMENDS;LIBRARY" "" ${ARGN})
  string(TOUPPER ${component} COMPONENT)
  list(APPEND CPACK_COMPONENTS_ALL ${component})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SECTION ${section})
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_DEPENDS "${package_DEPENDS}")
  set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_RECOMMENDS "${package_RECOMMENDS}")
  set(CPACK_DEBIAN_${COMPONENT}_DESCRIPTION "${summary}\n${text}")
  if(package_ALL)
    set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_ARCHITECTURE all)
    set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_SHLIBDEPS OFF)
  endif()
  # What the policy wants of every package: its licence and its history.
  set(folder ${PROJECT_BINARY_DIR}/packages/${name})
  configure_file(cmake/package/copyright.in ${folder}/copyright @ONLY)
  configure_file(cmake/package/changelog.in ${folder}/changelog.Debian @ONLY)
  execute_process(COMMAND gzip -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
  if(package_LIBRARY)  # CPack's own way is that of before Debian had triggers
    file(WRITE ${folder}/shlibs "${package_LIBRARY} ${QUINCUNX_ABI_VERSION} ${name} (>= ${PROJECT_VERSION})\n")
    file(WRITE ${folder}/triggers "activate-noawait ldconfig\n")
    set(CPACK_DEBIAN_${COMPONENT}_PACKAGE_CONTROL_EXTRA "${folder}/shlibs;${folder}/triggers")
  endif()
  install(FILES ${folder}/copyright ${folder}/changelog.Debian.gz
          DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${component} EXCLUDE_FROM_ALL)
endmacro()

set(about "Quincunx makes the screen's picture from frames that were rendered at a lower
resolution, another one every frame. Its OpenCL kernels filter, accumulate
frames over time, blur along motion and sharpen, on any OpenCL device.\n.\n")
set(opencl "pocl-opencl-icd | opencl-icd")
set(both "libquincunx1 ${exactly}, libquincunx-gl1 ${exactly}")
quincunx_package(lib_control libquincunx-control1 libs "dynamic resolution rendering with OpenCL: control"
  "${about}This package has the library that holds a frame rate by choosing resolutions.
It needs no OpenCL."
  LIBRARY libquincunx_control)
quincunx_package(lib libquincunx1 libs "dynamic resolution rendering with OpenCL: library"
  "${about}This package has the shared library, with its C++ and its C interface."
  LIBRARY libquincunx DEPENDS "libquincunx-control1 ${exactly}" RECOMMENDS "${opencl}")
quincunx_package(lib_gl libquincunx-gl1 libs "dynamic resolution rendering with OpenCL: OpenGL bridge"
  "${about}This package has the library that hands frames from OpenGL to OpenCL."
  LIBRARY libquincunx_gl DEPENDS "libquincunx1 ${exactly}")
quincunx_package(lib_record libquincunx-record1 libs "dynamic resolution rendering with OpenCL: recorder"
  "${about}This package has the library that writes a program's frames, with all settings,
into files that quincunx-resolve makes the same pictures of."
  LIBRARY libquincunx_record DEPENDS "libquincunx1 ${exactly}")
quincunx_package(dev_control libquincunx-control-dev libdevel
  "dynamic resolution rendering with OpenCL: development files of control"
  "${about}This package has the headers that choose resolutions, and what CMake and
pkg-config need to find them. They need no OpenCL."
  DEPENDS "libquincunx-control1 ${exactly}")
quincunx_package(dev libquincunx-dev libdevel "dynamic resolution rendering with OpenCL: development files"
  "${about}This package has headers and what CMake and pkg-config need to find them."
  DEPENDS "${both}, libquincunx-record1 ${exactly}, libquincunx-control-dev ${exactly}, ocl-icd-opencl-dev, libepoxy-dev")
quincunx_package(tools quincunx-tools graphics "dynamic resolution rendering with OpenCL: programs"
  "${about}This package has quincunx-render, which renders scenes, quincunx-resolve, which
makes full-size frames from EXR sequences, quincunx-dump, which shows the
stages of a frame, and quincunx-bench, which reports speed against error."
  DEPENDS "${both}, ${opencl}, fonts-dejavu-core" RECOMMENDS "libgl1-mesa-dri, libegl1, libgles2, libjs-chart.js")
quincunx_package(doc quincunx-doc doc "dynamic resolution rendering with OpenCL: documentation"
  "${about}This package has the documentation, with pictures." ALL)
quincunx_package(python python3-quincunx python "dynamic resolution rendering with OpenCL: Python module"
  "${about}This package has a module that resolves frames in NumPy arrays."
  DEPENDS "libquincunx1 (>= ${PROJECT_VERSION}), python3, python3-numpy, python3-cffi" ALL)
include(CPack)
