# SPDX-License-Identifier: BSD-3-Clause
# Test of installing, run by cmake -P: install, relocate, then configure, build and run a consumer of each component.
include("${CMAKE_CURRENT_LIST_DIR}/consuming.cmake")

file(REMOVE_RECURSE "${WORK}/first" "${WORK}/moved prefix")
run("${CMAKE_COMMAND}" --install "${BUILD}" --component kernels --prefix "${WORK}/first")
file(GLOB_RECURSE foreign "${WORK}/first/*solve*" "${WORK}/first/*HYPRE*" "${WORK}/first/bin/*")
if(foreign)
  message(FATAL_ERROR "not of the kernels: ${foreign}")
endif()
# An installed tree has to work at any place, also where the path contains a space.
set(prefix "${WORK}/moved prefix")
file(RENAME "${WORK}/first" "${prefix}")
consume(embed c,kernels ${forbidden})
consume(no_component "" ${forbidden} -DCMAKE_DISABLE_FIND_PACKAGE_Threads=ON -DCMAKE_DISABLE_FIND_PACKAGE_OpenMP=ON
  -DCMAKE_DISABLE_FIND_PACKAGE_METIS=ON)
run("${WORK}/no_component/use_c")

# The same through pkg-config, and an example as its README describes. A symbolic link gives the installation a path
# without a space, as users would do.
file(CREATE_LINK "${prefix}" "${WORK}/plain" SYMBOLIC)
file(GLOB_RECURSE package_file "${prefix}/*/kacanov.pc")
cmake_path(GET package_file PARENT_PATH libraries)
cmake_path(GET libraries PARENT_PATH libraries)
string(REPLACE "${prefix}" "${WORK}/plain" libraries "${libraries}")
consume_by_pkg_config(kacanov "${libraries}" "${C_COMPILER}" "${CONSUMER}/use_c.c" -lm)
consume_by_pkg_config(kacanov "${libraries}" "${C_COMPILER}" "${SOURCE}/kernels/examples/box_cg.c" -lm)
consume_by_pkg_config(kacanov-kernels "${libraries}" "${CXX_COMPILER}" "${CONSUMER}/use_kernels.cpp" -std=c++20)

if(SOLVER)
  run("${CMAKE_COMMAND}" --install "${BUILD}" --prefix "${prefix}")
  consume(all c,kernels,solver)
  consume(front_door solve ${forbidden})
  consume_by_pkg_config(kacanov-solve "${libraries}" "${C_COMPILER}" "${CONSUMER}/use_solve.c" -std=c99 -lm)
endif()
