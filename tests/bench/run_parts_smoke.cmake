# Runs quincunx-bench --parts on a tiny picture and reads its files. Of the times, only that there are some.
cmake_minimum_required(VERSION 3.25)

file(REMOVE_RECURSE ${FOLDER})
execute_process(COMMAND ${BENCH} --parts --base-scale 0.7 --output 97x61 --scenes particles --methods bilinear --scales 0.5
                        --frames 2 --warm-up 1 --truth 2 --out ${FOLDER}
                OUTPUT_VARIABLE text RESULT_VARIABLE code)
if(NOT code EQUAL 0)
  message(FATAL_ERROR "quincunx-bench --parts ended with ${code}")
endif()
file(READ ${FOLDER}/parts.json json)
string(JSON count LENGTH "${json}" rows)
if(NOT count EQUAL 11)
  message(FATAL_ERROR "there are ${count} rows, not two of the picture, four of the shadow map and five of particles")
endif()

function(expect_positive)
  string(JSON value ERROR_VARIABLE error GET "${json}" ${ARGN})
  if(error OR NOT value GREATER 0)
    message(FATAL_ERROR "${ARGN} is '${value}', not a positive number: ${error}")
  endif()
endfunction()
foreach(row RANGE 10)
  foreach(key draw resolve frame)
    expect_positive(rows ${row} ${key} ms)
    expect_positive(rows ${row} ${key} processor_ms)
  endforeach()
  expect_positive(rows ${row} psnr)
  expect_positive(rows ${row} flip)
endforeach()

# Coarser parts are further from truth.
function(expect_worse finer coarser)
  string(JSON fine GET "${json}" rows ${finer} psnr)
  string(JSON coarse GET "${json}" rows ${coarser} psnr)
  if(NOT coarse LESS fine)
    message(FATAL_ERROR "row ${coarser} has ${coarse} dB, row ${finer} ${fine} dB")
  endif()
endfunction()
expect_worse(0 1)   # the picture
expect_worse(0 5)   # the shadow map
expect_worse(6 10)  # particles

file(STRINGS ${FOLDER}/parts.csv lines)
list(LENGTH lines count)
if(NOT count EQUAL 12)
  message(FATAL_ERROR "parts.csv has ${count} lines, not 12")
endif()
foreach(bad "--base-scale;0" "--methods;none")
  execute_process(COMMAND ${BENCH} --parts ${bad} ERROR_VARIABLE text RESULT_VARIABLE code)
  if(NOT code EQUAL 2)
    message(FATAL_ERROR "${bad} ended with ${code}: ${text}")
  endif()
endforeach()
