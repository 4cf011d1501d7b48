# Runs the kernel tests that match FILTER under oclgrind, which checks every memory access and data races.
# Run as: cmake -D OCLGRIND=oclgrind -D TESTS=kernel_tests -D FILTER=pattern:... -P run_oclgrind.cmake
if(NOT OCLGRIND)
  if("$ENV{QUINCUNX_NO_SKIP}" STREQUAL "1")
    message(FATAL_ERROR "a skip is forbidden here (QUINCUNX_NO_SKIP=1): oclgrind is not installed; install the package oclgrind")
  endif()
  message("SKIPPED: oclgrind is not installed")
  return()
endif()

# Without optimisation: optimised, oclgrind stops at hints about memory that its compiler puts in where it inlines, and
# computes the minimum of int8 wrongly. It knows no prefetches. The macros keep headers from inlining. The program cache
# would hold binaries of another device.
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env QUINCUNX_CACHE_DIR= ${OCLGRIND} --check-api --data-races
          --build-options "-cl-opt-disable -D inline=inline -D IN_REGISTERS= -D __builtin_prefetch(...)="
          ${TESTS} --gtest_brief=1 --gtest_filter=${FILTER}
  RESULT_VARIABLE result OUTPUT_VARIABLE log ERROR_VARIABLE log)
string(LENGTH "${log}" length)
if(length GREATER 8000)
  string(SUBSTRING "${log}" 0 8000 log)
endif()
message("${log}")
if(NOT result EQUAL 0 OR log MATCHES "Invalid (read|write)|data race|Oclgrind - |OCLGRIND|Uninitialized|\\] 0 tests from")
  message(FATAL_ERROR "oclgrind found an error (exit status ${result})")
endif()
