# SPDX-License-Identifier: BSD-3-Clause
# The test itself, run by cmake -P: install, move, configure and build a consumer of each component, run it.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(code)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${code}): ${command}\n${output}")
  endif()
endfunction()

# The consumer that uses the given components, separated by commas; cmake arguments may follow.
function(consume name components)
  set(build "${WORK}/${name}")
  run("${CMAKE_COMMAND}" -S "${CONSUMER}" -B "${build}" -G "${GENERATOR}"
    "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
    "-DCMAKE_BUILD_TYPE=${CONFIGURATION}" "-DCMAKE_PREFIX_PATH=${prefix}" "-DCOMPONENTS=${components}" ${ARGN})
  run("${CMAKE_COMMAND}" --build "${build}")
  string(REPLACE "," ";" components "${components}")
  foreach(component IN LISTS components)
    run("${build}/use_${component}")
  endforeach()
endfunction()

file(REMOVE_RECURSE "${WORK}/first" "${WORK}/moved prefix" "${WORK}/embed" "${WORK}/all")
run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${WORK}/first")
# An installed tree has to work wherever it is put, also where there is a space.
set(prefix "${WORK}/moved prefix")
file(RENAME "${WORK}/first" "${prefix}")

# The kernels must not even look for what only the solver needs.
set(forbidden MPI HYPRE PARPACK Eigen3)
list(TRANSFORM forbidden REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")
consume(embed c,kernels ${forbidden})
if(SOLVER)
  consume(all c,kernels,solver)
endif()

# The same through pkg-config.
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE package_file "${prefix}/*/kacanov.pc")
  cmake_path(GET package_file PARENT_PATH folder)
  # What is installed from a folder with a space is linked by its plain name, as users would.
  file(CREATE_LINK "${prefix}" "${WORK}/plain" SYMBOLIC)
  string(REPLACE "${prefix}" "${WORK}/plain" folder "${folder}")
  set(ENV{PKG_CONFIG_PATH} "${folder}")
  foreach(package_and_source "kacanov;${C_COMPILER};use_c.c" "kacanov-kernels;${CXX_COMPILER};-std=c++20;use_kernels.cpp")
    list(POP_FRONT package_and_source package compiler)
    list(POP_BACK package_and_source source)
    execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs ${package}
      OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    separate_arguments(flags UNIX_COMMAND "${flags}")
    run("${compiler}" ${package_and_source} "${CONSUMER}/${source}" ${flags} -o "${WORK}/by_pkg_config")
    cmake_path(GET folder PARENT_PATH library_folder)
    run("${CMAKE_COMMAND}" -E env "LD_LIBRARY_PATH=${library_folder}" "${WORK}/by_pkg_config")
  endforeach()
endif()
