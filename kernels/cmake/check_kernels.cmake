# Compiles each row of variants.txt with clang's OpenCL C front end; stops at the end if any row failed.
# Run as: cmake -D CLANG=clang -D ROOT=kernels -D STAMP=file -P check_kernels.cmake
file(STRINGS "${ROOT}/variants.txt" rows REGEX "^[a-z]")
list(LENGTH rows count)
if(count EQUAL 0)
  message(FATAL_ERROR "${ROOT}/variants.txt lists no variant")
endif()
file(GLOB_RECURSE files "${ROOT}/*.cl")
set(failed 0)
foreach(row IN LISTS rows)
  separate_arguments(options UNIX_COMMAND "${row}")
  list(POP_FRONT options kernel)
  set(file ${files})
  list(FILTER file INCLUDE REGEX "/${kernel}\\.cl$")
  execute_process(
    COMMAND "${CLANG}" -x cl -cl-std=CL1.2 -target spir64-unknown-unknown -Xclang -finclude-default-header
            -fsyntax-only -Wall -Wextra -Wshadow -Werror -Wno-unused-function -Wno-unused-parameter
            -I "${ROOT}/include" ${options} "${file}"
    RESULT_VARIABLE result ERROR_VARIABLE log)
  if(NOT result EQUAL 0)
    message(SEND_ERROR "variant '${row}' does not compile:\n${log}")
    set(failed 1)
  endif()
endforeach()
if(NOT failed)
  file(WRITE "${STAMP}" "${count} variants\n")
endif()
