# SPDX-License-Identifier: BSD-3-Clause
# The kernels against their plain references.
kacanov_test(kernels
  SOURCES kernels/cells_test.cpp kernels/law_test.cpp kernels/reference_test.cpp kernels/operator_test.cpp
    kernels/operator_input_test.cpp kernels/point_moduli_test.cpp kernels/locking_test.cpp
    kernels/mixed_test.cpp kernels/uniaxial_test.cpp ../perf/meshes.cpp
  LIBRARIES kacanov_kernels_internal Eigen3::Eigen)
