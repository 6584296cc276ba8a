# SPDX-License-Identifier: BSD-3-Clause
kacanov_test(problem
  SOURCES solver/problem_main.cpp solver/problem_contact.cpp solver/problem_loads.cpp
          solver/problem_rigid_modes.cpp
  LIBRARIES kacanov_solver)

find_package(Eigen3 3.4 REQUIRED)
kacanov_test(algebra
  SOURCES solver/mpi_main.cpp solver/algebra_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen)
kacanov_test(multigrid
  SOURCES solver/mpi_main.cpp solver/multigrid_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen
  RANKS 1 2 3)
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

kacanov_test(checkpoint
  SOURCES solver/mpi_main.cpp solver/checkpoint_test.cpp
  LIBRARIES kacanov_solver
  RANKS 1 2)

kacanov_test(load_steps
  SOURCES solver/mpi_main.cpp solver/load_steps_test.cpp
  LIBRARIES kacanov_solver)

kacanov_test(random_problems
  SOURCES solver/mpi_main.cpp solver/random_test.cpp
  LIBRARIES kacanov_solver Eigen3::Eigen)

kacanov_test(half_space
  SOURCES solver/mpi_main.cpp solver/half_space_test.cpp
  LIBRARIES kacanov_solver)

kacanov_test(mesh
  SOURCES solver/mesh_test.cpp
  LIBRARIES kacanov_solver)

find_package(nlohmann_json REQUIRED)
kacanov_test(reference_cases
  SOURCES solver/mpi_main.cpp cases/reference_test.cpp
  LIBRARIES kacanov_io kacanov_solver nlohmann_json::nlohmann_json)
target_include_directories(test_reference_cases PRIVATE solver)
target_compile_definitions(test_reference_cases PRIVATE
  KACANOV_REFERENCE="${CMAKE_CURRENT_SOURCE_DIR}/cases/reference"
  KACANOV_ROCKER="${PROJECT_SOURCE_DIR}/tools/examples/rocker.msh")
kacanov_test(closed_solutions
  SOURCES solver/mpi_main.cpp solver/closed_test.cpp
  LIBRARIES kacanov_solver)
kacanov_test(contact
  SOURCES solver/mpi_main.cpp solver/contact_test.cpp
  LIBRARIES kacanov_solver)
kacanov_test(dual
  SOURCES solver/mpi_main.cpp solver/dual_test.cpp
  LIBRARIES kacanov_solver)
kacanov_test(certificate
  SOURCES solver/mpi_main.cpp solver/certificate_test.cpp
  LIBRARIES kacanov_solver)
kacanov_test(outer
  SOURCES solver/mpi_main.cpp solver/outer_test.cpp
  LIBRARIES kacanov_solver)
