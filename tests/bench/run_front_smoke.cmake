# Runs quincunx-bench --front on tiny pictures and reads its file. Of the times, only that there are some.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
set(ENV{QUINCUNX_CACHE_DIR} ${FOLDER}/cache)
execute_process(COMMAND ${BENCH} --front ${FOLDER}/front.json --output 64x36 --scales 0.5,1 --methods bilinear --frames 1
                        --warm-up 1 --rounds 2 --truth 2
                OUTPUT_VARIABLE text RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "quincunx-bench --front ended with ${code}")
endif()
if(NOT text MATCHES "zoom     bilinear +0\\.50:")
  message(FATAL_ERROR "the table has no row of zoom:\n${text}")
endif()
file(READ ${FOLDER}/front.json json)
string(JSON version GET "${json}" quincunx_error_front)
string(JSON count LENGTH "${json}" points)
if(NOT version EQUAL 1 OR NOT count EQUAL 12)
  message(FATAL_ERROR "version ${version} with ${count} points, not version 1 with two of each class")
endif()
foreach(row RANGE 11)
  foreach(column 3 5 7)  # FLIP, dB, ms
    string(JSON value GET "${json}" points ${row} ${column})
    if(NOT value GREATER 0)
      message(FATAL_ERROR "points ${row} ${column} is '${value}', not a positive number")
    endif()
  endforeach()
endforeach()

# The same lies where programs look for it.
file(GLOB kept ${FOLDER}/cache/front-*.json)
list(LENGTH kept count)
if(NOT count EQUAL 1)
  message(FATAL_ERROR "${count} fronts are kept, not 1")
endif()
file(READ ${kept} again)
if(NOT again STREQUAL json)
  message(FATAL_ERROR "${kept} differs from front.json")
endif()

foreach(bad "--scenes;pan" "--methods;bilinear@rgba8" "--out;${FOLDER}")
  execute_process(COMMAND ${BENCH} --front ${FOLDER}/bad.json ${bad} --output 64x36 --scales 1 --frames 1 --rounds 1 --truth 1
                  ERROR_VARIABLE text RESULT_VARIABLE code)
  if(NOT code EQUAL 2 OR EXISTS ${FOLDER}/bad.json)
    message(FATAL_ERROR "${bad} ended with ${code}: ${text}")
  endif()
endforeach()
