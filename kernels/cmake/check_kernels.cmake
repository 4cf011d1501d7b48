# Compiles each row of variants.txt that names the kernel of FILE with clang's OpenCL C front end, in both widths.
# Run as: cmake -D CLANG=clang -D ROOT=kernels -D FILE=kernel.cl -D STAMP=file -P check_kernels.cmake
get_filename_component(kernel "${FILE}" NAME_WE)
file(STRINGS "${ROOT}/variants.txt" rows REGEX "^${kernel}( |$)")
list(LENGTH rows count)
if(count EQUAL 0)
  message(FATAL_ERROR "${ROOT}/variants.txt lists no variant of ${kernel}")
endif()
set(failed 0)
foreach(row IN LISTS rows)
  separate_arguments(options UNIX_COMMAND "${row}")
  list(POP_FRONT options)
  foreach(lanes 8 1)
    execute_process(
      COMMAND "${CLANG}" -x cl -cl-std=CL1.2 -target spir64-unknown-unknown -Xclang -finclude-default-header
              -fsyntax-only -Wall -Wextra -Wshadow -Wundef -Werror -Wno-unused-function -Wno-unused-parameter
              -Wno-bitwise-instead-of-logical
              -I "${ROOT}/include" -D LANES=${lanes} ${options} "${FILE}"
      RESULT_VARIABLE result ERROR_VARIABLE log)
    if(NOT result EQUAL 0)
      message(SEND_ERROR "variant '${row}' with LANES=${lanes} does not compile:\n${log}")
      set(failed 1)
    endif()
  endforeach()
endforeach()
if(NOT failed)
  file(WRITE "${STAMP}" "${count} variants\n")
endif()
