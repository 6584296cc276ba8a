# SPDX-License-Identifier: BSD-3-Clause
# Tests of the kernels against their reference implementations.
add_library(kacanov_dense_algebra STATIC dense_algebra.cpp)
target_link_libraries(kacanov_dense_algebra PUBLIC Eigen3::Eigen PRIVATE kacanov_warnings)
target_compile_features(kacanov_dense_algebra PUBLIC cxx_std_20)
target_compile_options(kacanov_dense_algebra PRIVATE ${KACANOV_MEASURE_OPTIONS})

kacanov_test(kernels IN kernels
  SOURCES kernels/cells_test.cpp kernels/law_test.cpp kernels/reference_test.cpp kernels/operator_test.cpp
    kernels/simd_test.cpp kernels/mixed_test.cpp kernels/plane_test.cpp
    kernels/pressure_test.cpp kernels/pressure_patches_test.cpp kernels/threads_test.cpp ../perf/benchmarks/meshes.cpp
  LIBRARIES kacanov_kernels_internal kacanov_dense_algebra)
kacanov_test(locking IN kernels NUMBERS
  SOURCES kernels/locking_test.cpp
  LIBRARIES kacanov_kernels_internal)
kacanov_test_with_openmp(kernels test_kernels "--source-file=*threads_test.cpp")
