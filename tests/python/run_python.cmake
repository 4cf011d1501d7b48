# Runs quincunx_test.py with a Python that has NumPy: the one in the path, or the system's own.
# Run as: cmake -D LIBRARY=libquincunx.so -D RESOLVE=quincunx-resolve -D ROOT=FOLDER -P run_python.cmake
foreach(candidate python3 /usr/bin/python3)
  execute_process(COMMAND ${candidate} -c "import numpy" RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    set(python ${candidate})
    break()
  endif()
endforeach()
if(NOT python)
  if("$ENV{QUINCUNX_NO_SKIP}" STREQUAL "1")
    message(FATAL_ERROR "a skip is forbidden here (QUINCUNX_NO_SKIP=1): no Python has NumPy; install the package python3-numpy")
  endif()
  message("SKIPPED: no Python has NumPy")
  return()
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env QUINCUNX_LIBRARY=${LIBRARY} QUINCUNX_RESOLVE=${RESOLVE} PYTHONPATH=${ROOT}/host/tools/python
          PYTHONDONTWRITEBYTECODE=1 ${python} ${ROOT}/tests/python/quincunx_test.py
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "quincunx_test.py failed (exit status ${result})")
endif()
