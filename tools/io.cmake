# SPDX-License-Identifier: BSD-3-Clause
# File formats: Gmsh meshes in, VTK fields and SVG pictures out.
add_library(kacanov_io STATIC
  atomic_file.cpp
  gmsh_content.cpp
  gmsh_cursor.cpp
  gmsh_parser.cpp
  gmsh_reader.cpp
  mapped_file.cpp
  node_index.cpp
  vtu_writer.cpp)
target_include_directories(kacanov_io PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(kacanov_io PUBLIC kacanov_solver PRIVATE kacanov_warnings)
