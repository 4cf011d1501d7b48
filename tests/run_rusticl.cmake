# Runs a part of a test executable once more on Mesa's rusticl: another OpenCL, which goes another way through the
# compiler than PoCL.
# Run as: cmake -D ICD=.../rusticl.icd -D FOLDER=folder -D TESTS=executable -D FILTER=pattern:... -P run_rusticl.cmake
if(NOT ICD)
  if("$ENV{QUINCUNX_NO_SKIP}" STREQUAL "1")
    message(FATAL_ERROR "a skip is forbidden here (QUINCUNX_NO_SKIP=1): rusticl is not installed; install the package mesa-opencl-icd")
  endif()
  message("SKIPPED: rusticl is not installed")
  return()
endif()

# A folder with this driver alone: where it offers no device, there is none, and the tests fail.
file(COPY "${ICD}" DESTINATION "${FOLDER}")
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env OCL_ICD_VENDORS=${FOLDER}/ RUSTICL_ENABLE=llvmpipe ${TESTS} --gtest_brief=1
          --gtest_filter=${FILTER}
  RESULT_VARIABLE result OUTPUT_VARIABLE log ERROR_VARIABLE log)
message("${log}")
if(NOT result EQUAL 0)
  message(FATAL_ERROR "failed on rusticl (exit status ${result})")
endif()
if(NOT log MATCHES "[1-9][0-9]* tests? from")
  message(FATAL_ERROR "no test matches ${FILTER}")
endif()
