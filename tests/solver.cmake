# SPDX-License-Identifier: BSD-3-Clause
kacanov_test(problem
  SOURCES solver/problem_main.cpp solver/problem_contact.cpp solver/problem_loads.cpp
          solver/problem_rigid_modes.cpp
  LIBRARIES kacanov_solver)

find_package(Eigen3 3.4 REQUIRED)
kacanov_test(algebra
  SOURCES solver/mpi_main.cpp solver/algebra_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen)
kacanov_test(spectrum
  SOURCES solver/mpi_main.cpp solver/spectrum_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen)
kacanov_test(lanczos
  SOURCES solver/mpi_main.cpp solver/lanczos_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen
  RANKS 1 2 3)
kacanov_test(parallel
  SOURCES solver/mpi_main.cpp solver/parallel_test.cpp
  LIBRARIES kacanov_solver
  RANKS 1 2 3 4)

kacanov_test(mesh
  SOURCES solver/mesh_test.cpp
  LIBRARIES kacanov_solver)
