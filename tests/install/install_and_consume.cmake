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

# Runs a program that was linked against the installed shared library.
function(run_installed)
  cmake_path(GET pkgconfig_folder PARENT_PATH library_folder)
  run("${CMAKE_COMMAND}" -E env "LD_LIBRARY_PATH=${library_folder}" ${ARGN})
endfunction()

# Builds SOURCE with a compiler and what pkg-config says of PACKAGE, and runs it; more flags may follow.
function(consume_by_pkg_config package compiler source)
  execute_process(COMMAND "${PKG_CONFIG}" --cflags --libs ${package}
    OUTPUT_VARIABLE flags OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
  separate_arguments(flags UNIX_COMMAND "${flags}")
  run("${compiler}" "${source}" ${ARGN} ${flags} -o "${WORK}/by_pkg_config")
  run_installed("${WORK}/by_pkg_config")
endfunction()

# Neither building nor using the kernels may even look for what only the solver needs.
set(forbidden MPI HYPRE PARPACK Eigen3)
list(TRANSFORM forbidden REPLACE "(.+)" "-DCMAKE_DISABLE_FIND_PACKAGE_\\1=ON")

file(REMOVE_RECURSE "${WORK}/first" "${WORK}/moved prefix" "${WORK}/embed" "${WORK}/all" "${WORK}/alone")
run("${CMAKE_COMMAND}" -S "${SOURCE}" -B "${WORK}/alone" -G "${GENERATOR}"
  "-DCMAKE_C_COMPILER=${C_COMPILER}" "-DCMAKE_CXX_COMPILER=${CXX_COMPILER}"
  -DKACANOV_SOLVER=OFF -DKACANOV_TESTS=OFF ${forbidden})

run("${CMAKE_COMMAND}" --install "${BUILD}" --component kernels --prefix "${WORK}/first")
file(GLOB_RECURSE foreign "${WORK}/first/*solve*" "${WORK}/first/*HYPRE*" "${WORK}/first/bin/*")
if(foreign)
  message(FATAL_ERROR "not of the kernels: ${foreign}")
endif()
# An installed tree has to work wherever it is put, also where there is a space.
set(prefix "${WORK}/moved prefix")
file(RENAME "${WORK}/first" "${prefix}")
consume(embed c,kernels ${forbidden})

# The same through pkg-config, and an example as its README says.
find_program(PKG_CONFIG pkg-config)
if(PKG_CONFIG)
  file(GLOB_RECURSE package_file "${prefix}/*/kacanov.pc")
  cmake_path(GET package_file PARENT_PATH pkgconfig_folder)
  # What is installed in a folder with a space is linked by its plain name, as users would.
  file(CREATE_LINK "${prefix}" "${WORK}/plain" SYMBOLIC)
  string(REPLACE "${prefix}" "${WORK}/plain" pkgconfig_folder "${pkgconfig_folder}")
  set(ENV{PKG_CONFIG_PATH} "${pkgconfig_folder}")
  consume_by_pkg_config(kacanov "${C_COMPILER}" "${CONSUMER}/use_c.c" -lm)
  consume_by_pkg_config(kacanov "${C_COMPILER}" "${SOURCE}/kernels/examples/box_cg.c" -lm)
  consume_by_pkg_config(kacanov-kernels "${CXX_COMPILER}" "${CONSUMER}/use_kernels.cpp" -std=c++20)
endif()

if(SOLVER)
  run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
  consume(all c,kernels,solver)
endif()
