# blender-extension: a target that makes quincunx-blender-VERSION-linux-ARCH.zip, the add-on as an extension of Blender
# 4.2 and later. It carries quincunx-resolve and the libraries that it loads, but those of every Linux. OpenImageIO
# would bring 250 more, so this program reads and writes EXR and PNG alone.
#
# As a script (-P) this file fills the folder of the zip and packs it.
if(CMAKE_SCRIPT_MODE_FILE)
  # These come with every system. Drivers are loaded into the program, too, and may need newer ones than a bundle has.
  set(of_system "^lib(c|m|z|dl|rt|pthread|gcc_s|stdc\\+\\+)\\.so" "^ld-linux")
  file(GET_RUNTIME_DEPENDENCIES EXECUTABLES ${PROGRAM} RESOLVED_DEPENDENCIES_VAR libraries
       PRE_EXCLUDE_REGEXES ${of_system})
  file(REMOVE_RECURSE ${FOLDER})
  file(MAKE_DIRECTORY ${FOLDER}/bin ${FOLDER}/lib ${FOLDER}/licences)
  file(COPY_FILE ${ADD_ON} ${FOLDER}/__init__.py)
  file(COPY_FILE ${LICENCE} ${FOLDER}/licences/quincunx)
  file(COPY_FILE ${PROGRAM} ${FOLDER}/bin/quincunx-resolve)
  execute_process(COMMAND ${STRIP} ${FOLDER}/bin/quincunx-resolve COMMAND_ERROR_IS_FATAL ANY)
  foreach(library IN LISTS libraries)
    cmake_path(GET library FILENAME name)
    file(REAL_PATH ${library} real)
    file(COPY_FILE ${real} ${FOLDER}/lib/${name})
    execute_process(COMMAND dpkg-query -S ${real} OUTPUT_VARIABLE package ERROR_QUIET)
    string(REGEX REPLACE ":.*" "" package "${package}")
    if(package)  # of Debian, whose texts say on which conditions it may be passed on
      file(COPY_FILE /usr/share/doc/${package}/copyright ${FOLDER}/licences/${package})
    endif()
  endforeach()
  file(WRITE ${FOLDER}/blender_manifest.toml
"schema_version = \"1.0.0\"
id = \"quincunx\"
version = \"${VERSION}\"
name = \"Quincunx\"
tagline = \"Render small with Cycles, resolve to full size\"
maintainer = \"The Quincunx maintainers\"
type = \"add-on\"
tags = [\"Render\"]
blender_version_min = \"4.2.0\"
license = [\"SPDX:MIT\"]
platforms = [\"${PLATFORM}\"]

[permissions]
files = \"Write the rendered frames, and run quincunx-resolve on them\"
")
  file(GLOB content RELATIVE ${FOLDER} ${FOLDER}/*)
  file(REMOVE ${ZIP})
  execute_process(COMMAND ${CMAKE_COMMAND} -E tar cf ${ZIP} --format=zip ${content} WORKING_DIRECTORY ${FOLDER}
                  COMMAND_ERROR_IS_FATAL ANY)
  return()
endif()

# The program once more, which looks for libraries beside itself before all other places, for itself and for them.
quincunx_resolve_program(quincunx-resolve-bundled EXCLUDE_FROM_ALL)
target_link_options(quincunx-resolve-bundled PRIVATE LINKER:--disable-new-dtags)
set_target_properties(quincunx-resolve-bundled PROPERTIES
  QUINCUNX_IMAGE_IO openexr BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH "$ORIGIN/../lib")

string(REPLACE "x86_64" "x64" platform "linux-${CMAKE_SYSTEM_PROCESSOR}")
string(REPLACE "aarch64" "arm64" platform "${platform}")
set(zip ${PROJECT_BINARY_DIR}/quincunx-blender-${PROJECT_VERSION}-${platform}.zip)
set(add_on ${PROJECT_SOURCE_DIR}/host/tools/blender/quincunx_blender.py)
add_custom_command(
  OUTPUT ${zip}
  COMMAND ${CMAKE_COMMAND} -D PROGRAM=$<TARGET_FILE:quincunx-resolve-bundled> -D ADD_ON=${add_on}
          -D LICENCE=${PROJECT_SOURCE_DIR}/LICENSE -D FOLDER=${PROJECT_BINARY_DIR}/blender_extension
          -D STRIP=${CMAKE_STRIP} -D VERSION=${PROJECT_VERSION} -D PLATFORM=${platform} -D ZIP=${zip}
          -P ${CMAKE_CURRENT_LIST_FILE}
  DEPENDS quincunx-resolve-bundled ${add_on} ${CMAKE_CURRENT_LIST_FILE} ${PROJECT_SOURCE_DIR}/LICENSE
  COMMENT "Packing ${zip}"
  VERBATIM)
add_custom_target(blender-extension DEPENDS ${zip})
set_target_properties(blender-extension PROPERTIES ZIP ${zip})
