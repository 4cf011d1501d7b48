# Installs into an empty prefix, configures and builds the client with nothing else to go by, and runs it.
function(step what)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE result OUTPUT_VARIABLE log ERROR_VARIABLE log)
  if(NOT result EQUAL 0)
    message(FATAL_ERROR "${what} failed (${result}):\n${log}")
  endif()
  message(STATUS "${what}: good")
endfunction()

file(REMOVE_RECURSE ${WORK})
step("install" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
step("configure" ${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build -D CMAKE_PREFIX_PATH=${WORK}/prefix
     -D CMAKE_BUILD_TYPE=${BUILD_TYPE} -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS}
     -D EXAMPLES=${EXAMPLES} -D CMAKE_C_COMPILER=${C_COMPILER} -D CMAKE_C_FLAGS=${FLAGS} -D GL_INTEROP=${GL_INTEROP} -D RECORD=${RECORD})
step("build" ${CMAKE_COMMAND} --build ${WORK}/build)
step("run" ${WORK}/build/minimal ${WORK}/minimal.ppm)
step("run in C" ${WORK}/build/minimal_c ${WORK}/minimal_c.ppm)
step("compare both pictures" ${CMAKE_COMMAND} -E compare_files ${WORK}/minimal.ppm ${WORK}/minimal_c.ppm)

# The same by pkg-config.
find_program(PKG_CONFIG pkg-config REQUIRED)
file(GLOB_RECURSE pc ${WORK}/prefix/*/quincunx.pc)
get_filename_component(pc_folder "${pc}" DIRECTORY)
set(ENV{PKG_CONFIG_PATH} ${pc_folder})
execute_process(COMMAND ${PKG_CONFIG} --cflags --libs quincunx OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE
                COMMAND_ERROR_IS_FATAL ANY)
separate_arguments(flags UNIX_COMMAND "${FLAGS} ${flags}")
step("build by pkg-config" ${C_COMPILER} -std=c99 ${EXAMPLES}/minimal.c -o ${WORK}/by_pkg_config ${flags} -lm)
step("run what pkg-config built" ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc_folder}/.. ${WORK}/by_pkg_config
     ${WORK}/by_pkg_config.ppm)

# Control in a prefix of its own, where OpenCL is not found.
foreach(component lib_control dev_control)
  step("install ${component} alone" ${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/control --component ${component})
endforeach()
step("configure control" ${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build_control -D CONTROL_ALONE=ON
     -D CMAKE_PREFIX_PATH=${WORK}/control -D CMAKE_DISABLE_FIND_PACKAGE_OpenCL=ON -D CMAKE_BUILD_TYPE=${BUILD_TYPE}
     -D CMAKE_CXX_COMPILER=${COMPILER} -D CMAKE_CXX_FLAGS=${FLAGS})
step("build control" ${CMAKE_COMMAND} --build ${WORK}/build_control)
step("run control" ${WORK}/build_control/control_client)
execute_process(COMMAND sh -c "readelf --dynamic control_client | grep -i opencl" WORKING_DIRECTORY ${WORK}/build_control
                OUTPUT_VARIABLE opencl)
if(opencl)
  message(FATAL_ERROR "control loads OpenCL: ${opencl}")
endif()

if(GL_INTEROP)
  step("run with OpenGL" ${WORK}/build/gl_client)
endif()
if(RECORD)
  step("record" ${WORK}/build/record_client ${WORK}/recorded)
  step("replay" ${CMAKE_COMMAND} -E env LD_LIBRARY_PATH=${pc_folder}/.. ${WORK}/prefix/bin/quincunx-resolve
       ${WORK}/recorded --out ${WORK}/again.%04d.png -q)
  execute_process(COMMAND ${PKG_CONFIG} --cflags --libs quincunx-record OUTPUT_VARIABLE flags
                  OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${FLAGS} ${flags}")
  step("build the recorder by pkg-config" ${COMPILER} -std=c++20 ${SOURCE}/record_client.cpp -o ${WORK}/record_by_pkg_config
       ${flags})
endif()
