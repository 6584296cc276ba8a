# SPDX-License-Identifier: BSD-3-Clause
# Tests of the solver: one program per module, and whole solves.
kacanov_test(problem IN solver
  MPI SOURCES solver/obstacles_test.cpp solver/problem_test.cpp solver/problem_validate_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

find_package(Eigen3 3.4 REQUIRED)
add_library(kacanov_dense_matrices STATIC solver/dense.cpp)
target_link_libraries(kacanov_dense_matrices PUBLIC kacanov_dense_algebra kacanov_solver_internal
  kacanov_kernels_internal PRIVATE kacanov_warnings)
target_compile_options(kacanov_dense_matrices PRIVATE ${KACANOV_MEASURE_OPTIONS})
kacanov_test(algebra IN solver
  MPI SOURCES solver/algebra_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal kacanov_dense_matrices)
kacanov_test(multigrid IN solver
  MPI SOURCES solver/coarse_amg_test.cpp solver/multigrid_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal Eigen3::Eigen
  RANKS 1 2 3)
kacanov_test(spectrum IN numbers
  MPI NUMBERS SOURCES solver/spectrum_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal kacanov_dense_matrices)
kacanov_test(lanczos IN solver
  MPI SOURCES solver/lanczos_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal kacanov_dense_algebra
  RANKS 1 2 3)
kacanov_test(parallel IN solver
  MPI SOURCES solver/partition_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 3 4)

kacanov_test(checkpoint IN solver
  MPI SOURCES solver/checkpoint_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2)

kacanov_test(coarse_start IN numbers
  MPI NUMBERS SOURCES solver/coarse_start_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(load_steps IN solver
  MPI SOURCES solver/load_steps_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(entry_totals IN solver
  MPI SOURCES solver/entry_totals_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 3)

kacanov_test(validity IN solver
  MPI SOURCES solver/warnings_test.cpp solver/uniaxial_bar_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(nodal_stress IN solver
  MPI SOURCES solver/recovery_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 3)

# The dense reference solver, independent of the solver under test.
add_library(kacanov_dense_solver STATIC solver/dense_solver.cpp)
target_link_libraries(kacanov_dense_solver PUBLIC kacanov_solver_internal kacanov_kernels_internal Eigen3::Eigen
  PRIVATE kacanov_warnings)
target_compile_features(kacanov_dense_solver PUBLIC cxx_std_20)
target_compile_options(kacanov_dense_solver PRIVATE ${KACANOV_MEASURE_OPTIONS})

kacanov_test(random_problems IN solver
  MPI SOURCES solver/random_test.cpp
  LIBRARIES kacanov_dense_solver)

kacanov_test(half_space IN numbers
  MPI NUMBERS SOURCES solver/half_space_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(pressed_obstacles IN solver
  MPI SOURCES solver/pressed_obstacles_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(moving IN solver
  MPI SOURCES solver/moving_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2)

kacanov_test(quadratic_contact IN solver
  MPI SOURCES solver/quadratic_contact_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal kacanov_formats
  RANKS 1 2 4)
target_compile_definitions(test_solver PRIVATE
  KACANOV_UNEVEN_CUBE="${CMAKE_CURRENT_SOURCE_DIR}/cases/patch/uneven_cube.msh")

kacanov_test(friction_history IN numbers
  MPI NUMBERS SOURCES solver/friction_history_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2)

kacanov_test(closed_friction IN numbers
  MPI NUMBERS SOURCES solver/closed_friction_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 4)

kacanov_test(mesh IN solver
  MPI SOURCES solver/mesh_test.cpp solver/refine_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)

kacanov_test(closed_solutions IN numbers
  MPI NUMBERS SOURCES solver/closed_test.cpp solver/plane_state_test.cpp solver/radial_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(contact IN solver
  MPI SOURCES solver/contact_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(coulomb IN solver
  MPI SOURCES solver/coulomb_test.cpp solver/loose_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal Eigen3::Eigen)
kacanov_test(wide_contact IN solver
  MPI SOURCES solver/wide_contact_test.cpp
  LIBRARIES kacanov_dense_solver
  RANKS 1 2 3)
kacanov_test(dual IN numbers
  MPI NUMBERS SOURCES solver/dual_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(units IN solver
  MPI SOURCES solver/units_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(certificate IN solver
  MPI SOURCES solver/certificate_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(regions IN solver
  MPI SOURCES solver/regions_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 3)
kacanov_test(outer IN numbers
  MPI NUMBERS SOURCES solver/outer_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(nonlinear IN solver
  MPI SOURCES solver/nonlinear_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal)
kacanov_test(pressure_multigrid IN solver
  MPI SOURCES solver/element_pressures_test.cpp solver/pressure_multigrid_test.cpp solver/pressure_schur_test.cpp
  LIBRARIES kacanov_solver_internal kacanov_kernels_internal
  RANKS 1 2 3)

# Whole runs against reference values.
if(KACANOV_SLOW_TESTS)
  find_package(nlohmann_json REQUIRED)
  kacanov_test(reference_cases
    MPI SOURCES cases/reference_test.cpp
    LIBRARIES kacanov_formats nlohmann_json::nlohmann_json)
  target_include_directories(test_reference_cases PRIVATE solver)
  target_compile_definitions(test_reference_cases PRIVATE
    KACANOV_REFERENCE="${CMAKE_CURRENT_SOURCE_DIR}/cases/reference"
    KACANOV_ROCKER="${PROJECT_SOURCE_DIR}/tools/examples/rocker.msh")
endif()
