# SPDX-License-Identifier: BSD-3-Clause
# Test of add_subdirectory, run by cmake -P: a host in C with shared libraries and absolute folders, then the same with
# C++; the exported symbols of the C library; and pkg-config for an installation from there.
include("${CMAKE_CURRENT_LIST_DIR}/consuming.cmake")

set(absolute "${WORK}/absolute")
file(REMOVE_RECURSE "${WORK}/host" "${absolute}")
# A unity build compiles in half the time, and the plain kernels suffice.
set(arguments -DCMAKE_UNITY_BUILD=ON -DKACANOV_VECTOR_KERNELS=OFF "-DKACANOV=${SOURCE}" -DKACANOV_INSTALL=ON -DBUILD_SHARED_LIBS=ON "-DCMAKE_INSTALL_PREFIX=${absolute}/else"
  "-DCMAKE_INSTALL_LIBDIR=${absolute}/libraries" "-DCMAKE_INSTALL_INCLUDEDIR=${absolute}/headers" ${forbidden_to_build})
configure(host "${HOST}" ${arguments})
run("${CMAKE_COMMAND}" --build "${WORK}/host")
run("${WORK}/host/use_c")
if(EXISTS "${WORK}/host/compile_commands.json")
  message(FATAL_ERROR "kacanov writes compile commands for its host")
endif()

configure(host "${HOST}" ${arguments} -DCPP=ON)
run("${CMAKE_COMMAND}" --build "${WORK}/host")
run("${WORK}/host/use_kernels")

execute_process(COMMAND "${NM}" --dynamic --defined-only --format=posix "${WORK}/host/kacanov/kernels/libkacanov.so"
  OUTPUT_VARIABLE symbols COMMAND_ERROR_IS_FATAL ANY)
string(REGEX MATCHALL "[^\n]+" symbols "${symbols}")
list(FILTER symbols EXCLUDE REGEX "^kacanov_[a-z_]+ T")
if(symbols)
  message(FATAL_ERROR "the C library shows more than its functions: ${symbols}")
endif()

run("${CMAKE_COMMAND}" --install "${WORK}/host" --component kernels)
if(EXISTS "${absolute}/else")
  message(FATAL_ERROR "something of the kernels is not in the absolute folders")
endif()
set(prefix "${absolute}/libraries/cmake/kacanov")
consume(by_absolute_folders c,kernels ${forbidden})
consume_by_pkg_config(kacanov "${absolute}/libraries" "${C_COMPILER}" "${CONSUMER}/use_c.c" -lm)
consume_by_pkg_config(kacanov-kernels "${absolute}/libraries" "${CXX_COMPILER}" "${CONSUMER}/use_kernels.cpp"
  -std=c++20)
