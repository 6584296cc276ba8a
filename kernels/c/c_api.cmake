# SPDX-License-Identifier: BSD-3-Clause
# The C interface: a shared library of its own that shows C functions only and brings all it needs.
add_library(kacanov_c SHARED
  "${PROJECT_SOURCE_DIR}/kernels/c/api.cpp"
  "${PROJECT_SOURCE_DIR}/kernels/c/create.cpp"
  "${PROJECT_SOURCE_DIR}/kernels/c/float.cpp"
  "${PROJECT_SOURCE_DIR}/kernels/c/laws.cpp")
add_library(kacanov::c ALIAS kacanov_c)
set_target_properties(kacanov_c PROPERTIES
  EXPORT_NAME c OUTPUT_NAME kacanov LIBRARY_OUTPUT_DIRECTORY "${PROJECT_BINARY_DIR}/kernels"
  VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR}
  CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON)
target_include_directories(kacanov_c INTERFACE
  $<BUILD_INTERFACE:${PROJECT_SOURCE_DIR}/kernels/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
target_compile_definitions(kacanov_c PRIVATE KACANOV_VERSION="${PROJECT_VERSION}")
target_link_libraries(kacanov_c PRIVATE kacanov_kernels_internal kacanov_warnings)
target_link_options(kacanov_c PRIVATE -Wl,--exclude-libs,ALL)
