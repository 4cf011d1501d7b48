# Runs quincunx_test.py with a Python that has NumPy and cffi: the one in the path, or the system's own.
# Run as: cmake -D LIBRARY=libquincunx.so -D RESOLVE=quincunx-resolve -D ROOT=FOLDER -P run_python.cmake
foreach(candidate python3 /usr/bin/python3)
  execute_process(COMMAND ${candidate} -c "import cffi, numpy" RESULT_VARIABLE result OUTPUT_QUIET ERROR_QUIET)
  if(result EQUAL 0)
    set(python ${candidate})
    break()
  endif()
endforeach()
if(NOT python)
  if("$ENV{QUINCUNX_NO_SKIP}" STREQUAL "1")
    message(FATAL_ERROR "a skip is forbidden here (QUINCUNX_NO_SKIP=1): no Python has NumPy and cffi; install the packages python3-numpy and python3-cffi")
  endif()
  message("SKIPPED: no Python has NumPy and cffi")
  return()
endif()
execute_process(
  COMMAND ${CMAKE_COMMAND} -E env QUINCUNX_LIBRARY=${LIBRARY} QUINCUNX_RESOLVE=${RESOLVE} PYTHONPATH=${ROOT}/host/tools/python
          PYTHONDONTWRITEBYTECODE=1 ${python} ${ROOT}/tests/python/quincunx_test.py
  RESULT_VARIABLE result)
if(NOT result EQUAL 0)
  message(FATAL_ERROR "quincunx_test.py failed (exit status ${result})")
endif()
