# SPDX-License-Identifier: BSD-3-Clause
# Functions of the installation tests: run a command, configure and build a consumer, consume by pkg-config.
find_program(PKG_CONFIG pkg-config REQUIRED)

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(code)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${code}): ${command}\n${output}")
  endif()
endfunction()

# Configures a project of these tests in a folder of this name; accepts further cmake arguments.
function(configure name source)
  run("${CMAKE_COMMAND}" -S "${source}" -B "${WORK}/${name}" -G "${GENERATOR}"
    "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}" ${ARGN})
endfunction()

# Builds and runs the consumer with the given components (separated by commas) of the installation in `prefix`; accepts
# further cmake arguments.
function(consume name components)
  file(REMOVE_RECURSE "${WORK}/${name}")
  configure(${name} "${CONSUMER}" "-DCMAKE_BUILD_TYPE=${CONFIGURATION}" "-DCMAKE_PREFIX_PATH=${prefix}"
    "-DCOMPONENTS=${components}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${WORK}/${name}")
  string(REPLACE "," ";" components "${components}")
  foreach(component IN LISTS components)
    run("${WORK}/${name}/use_${component}")
  endforeach()
endfunction()

# Compiles a source file with the flags that pkg-config returns for a package in the library folder, and runs it with
# that folder's shared library; accepts further flags.
function(consume_by_pkg_config package libraries compiler source)
  execute_process(
    COMMAND "${CMAKE_COMMAND}" -E env "PKG_CONFIG_PATH=${libraries}/pkgconfig" "${PKG_CONFIG}" --cflags --libs ${package}
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run("${compiler}" "${source}" ${ARGN} ${flags} -o "${WORK}/by_pkg_config")
  run("${CMAKE_COMMAND}" -E env "LD_LIBRARY_PATH=${libraries}" "${WORK}/by_pkg_config")
endfunction()

# Neither building nor using the kernels may search for the solver's dependencies; using them may not search for Eigen,
# whose headers only the build needs.
set(forbidden_to_build MPI HYPRE PARPACK)
set(forbidden ${forbidden_to_build} Eigen3)
foreach(list forbidden forbidden_to_build)
  list(TRANSFORM ${list} REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
endforeach()
