# SPDX-License-Identifier: BSD-3-Clause
# Tests of the Python package in the build folder: ctest -L python. CI runs those labelled wheel on a wheel instead.
file(GLOB petsc4py "/usr/lib/petscdir/*/*-real/lib/python3/dist-packages")  # Debian's place without the -dev package
if(petsc4py)
  list(GET petsc4py 0 petsc4py)
endif()
foreach(area case dolfinx notebooks operator own_law petsc plot steps)
  add_test(NAME python_${area} COMMAND "${PYTHON_EXECUTABLE}" -B -m unittest test_${area}
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}/python/tests")
  kacanov_test_properties(python_${area} 1)
  get_test_property(python_${area} ENVIRONMENT environment)
  set_tests_properties(python_${area} PROPERTIES LABELS "python;wheel"
    ENVIRONMENT "${environment};PYTHONPATH=${PROJECT_BINARY_DIR}/python:${petsc4py};KACANOV_PROGRAM=$<TARGET_FILE:kacanov>")
endforeach()

execute_process(COMMAND "${PYTHON_EXECUTABLE}" -c "import mpi4py" RESULT_VARIABLE without_mpi4py ERROR_QUIET)
if(NOT without_mpi4py)
  add_test(NAME python_mpi_2
    COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} 2 "${PYTHON_EXECUTABLE}" -B mpi_solve.py
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}/python/tests")
  kacanov_test_properties(python_mpi_2 2)
  get_test_property(python_mpi_2 ENVIRONMENT environment)
  set_tests_properties(python_mpi_2 PROPERTIES LABELS python
    ENVIRONMENT "${environment};PYTHONPATH=${PROJECT_BINARY_DIR}/python")
endif()

execute_process(COMMAND "${PYTHON_EXECUTABLE}" -c "import dolfinx, petsc4py" RESULT_VARIABLE without_dolfinx
  OUTPUT_QUIET ERROR_QUIET)
if(NOT without_dolfinx)
  add_test(NAME python_dolfinx_2
    COMMAND ${MPIEXEC_EXECUTABLE} ${MPIEXEC_NUMPROC_FLAG} 2 "${PYTHON_EXECUTABLE}" -B mpi_dolfinx.py
    WORKING_DIRECTORY "${PROJECT_SOURCE_DIR}/python/tests")
  kacanov_test_properties(python_dolfinx_2 2)
  get_test_property(python_dolfinx_2 ENVIRONMENT environment)
  set_tests_properties(python_dolfinx_2 PROPERTIES LABELS python
    ENVIRONMENT "${environment};PYTHONPATH=${PROJECT_BINARY_DIR}/python")
  add_test(NAME example_dolfinx COMMAND "${PYTHON_EXECUTABLE}" -B "${PROJECT_SOURCE_DIR}/python/examples/dolfinx_multigrid.py"
    --cells 4 --with-matrix)
  kacanov_test_properties(example_dolfinx 2)
  get_test_property(example_dolfinx ENVIRONMENT environment)
  set_tests_properties(example_dolfinx PROPERTIES LABELS python
    ENVIRONMENT "${environment};PYTHONPATH=${PROJECT_BINARY_DIR}/python")
endif()
