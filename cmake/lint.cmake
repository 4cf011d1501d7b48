# Targets `format` and `format-check`. Versions of clang-format disagree about details, so only the one that the
# project is formatted with counts: 14, that of Debian 12.
set(QUINCUNX_CLANG_FORMAT_VERSION 14)
find_program(QUINCUNX_CLANG_FORMAT NAMES clang-format-${QUINCUNX_CLANG_FORMAT_VERSION} clang-format)
if(NOT QUINCUNX_CLANG_FORMAT)
  return()
endif()
execute_process(COMMAND ${QUINCUNX_CLANG_FORMAT} --version OUTPUT_VARIABLE version_text)
if(NOT version_text MATCHES "version ${QUINCUNX_CLANG_FORMAT_VERSION}\\.")
  message(STATUS "no targets format and format-check: they need clang-format ${QUINCUNX_CLANG_FORMAT_VERSION}")
  return()
endif()

file(GLOB_RECURSE quincunx_formatted_files CONFIGURE_DEPENDS  # kernels/include is OpenCL C, set by hand
     cmake/*.h host/*.h host/*.cpp gl_interop/*.h gl_interop/*.cpp scenes/*.h scenes/*.cpp tests/*.h tests/*.cpp)
add_custom_target(format COMMAND ${QUINCUNX_CLANG_FORMAT} -i ${quincunx_formatted_files}
                  COMMENT "Formatting" VERBATIM)
add_custom_target(format-check COMMAND ${QUINCUNX_CLANG_FORMAT} --dry-run --Werror ${quincunx_formatted_files}
                  COMMENT "Checking the format" VERBATIM)
