# Runs a few kernel tests on small frames under oclgrind, which checks every memory access and data races.
# Run as: cmake -D OCLGRIND=oclgrind -D TESTS=kernel_tests -P run_oclgrind.cmake
if(NOT OCLGRIND)
  if("$ENV{QUINCUNX_NO_SKIP}" STREQUAL "1")
    message(FATAL_ERROR "a skip is forbidden here (QUINCUNX_NO_SKIP=1): oclgrind is not installed; install the package oclgrind")
  endif()
  message("SKIPPED: oclgrind is not installed")
  return()
endif()

function(check options)
  string(JOIN ":" filter ${ARGN})
  # The program cache would hold binaries of another device.
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env QUINCUNX_CACHE_DIR= ${OCLGRIND} ${options} --check-api --data-races ${TESTS}
            --gtest_brief=1 --gtest_filter=${filter}
    RESULT_VARIABLE result OUTPUT_VARIABLE log ERROR_VARIABLE log)
  string(LENGTH "${log}" length)
  if(length GREATER 8000)
    string(SUBSTRING "${log}" 0 8000 log)
  endif()
  message("${log}")
  if(NOT result EQUAL 0 OR log MATCHES "Invalid (read|write)|data race|Oclgrind - |OCLGRIND|Uninitialized|\\] 0 tests from")
    message(FATAL_ERROR "oclgrind found an error (exit status ${result})")
  endif()
endfunction()

# Footprints and poison reach every edge of the viewport; one variant of each kernel, both storages.
check("" "AxisTables.*" "Clear*"
  "*Present.CountsNonFinite*/aces_dither_RGBA32F_to_*"
  "*Present.CountsNonFinite*/clamp_RGBA16F_to_buffer"
  "*Scale.ATight*_buffer_RGBA16F_to_RGBA32F" "*Resolve.ATight*_reactive_buffer_*_to_RGBA32F"
  "*Scale.Poison*_buffer_RGBA16F_to_RGBA32F" "*Scale.ANon*bilinear_*_RGBA32F_to_RGBA16F"
  "*Resolve.Poison*/velocity_reactive_buffer_RGBA16F_RG16F_to_RGBA32F"
  "*Resolve.ANon*/velocity_reactive_buffer_RGBA16F_RG16F_to_RGBA32F"
  "*Scale.ATight*/point_*_RGBA8_to_RGBA32F" "*Scale.ATight*/bilinear_*_RGBA8_to_RGBA32F"
  "*Resolve.ATight*/velocity_reactive_buffer_RGBA8_*_to_RGBA32F"
  "*Velocity.ATight*" "*Velocity.Poison*" "*UndilateVelocityPass.ATight*" "*UndilateVelocityPass.Poison*"
  "*CrossFade.Poison*" "*MeasureContent.Poison*")
# These run without optimisation. Optimised, the first stops oclgrind at hints about memory that its compiler puts in
# where it inlines, and of the other it computes the minimum of int8 wrongly. The macros keep headers from
# inlining.
check("--build-options;-cl-opt-disable -D inline=inline -D IN_REGISTERS="
  "*MotionBlur.ATight*" "*Sharpen.ATight*" "*Sharpen.ANonFinite*"
  "*TemporalRefine.ATight*" "*TemporalRefine.ANonFinite*"
  "*Overlay.ATight*/reactive_*" "*Overlay.Poison*/reactive_buffer_RGBA16F"
  "*LayFocus.TightImages*" "*LayFocus.ANonFinite*"
  "*Checkerboard.ATight*/camera_buffer_*" "*Checkerboard.ATight*/moving_velocity_reactive_buffer_*"
  "*Reprojected.ATight*/still_reactive_buffer_RGBA16F_RG16F_to_RGBA32F"
  "*Reprojected.ATight*/moving_residual_reactive_buffer_RGBA16F_RG16F*"
  "*Temporal.ATight*/moving_buffer_RGBA16F_history_RGBA16F_to_RGBA16F"
  "*Temporal.ATight*/still_reactive_buffer_*" "TemporalLight*"
  "*TemporalTiles.ATight*/moving_layered_buffer_RGBA16F_history_RGBA16F_*" "*LayerSplits.ATight*"
  "*Layers.ATight*/moving_buffer_RGBA16F_history_RGBA16F_to_RGBA16F"
  "*Resize.ATight*/moving_alpha_buffer_RGBA16F_history_RGBA16F_*" "*Resize.Records*/moving_buffer_*")
