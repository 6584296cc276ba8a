# SPDX-License-Identifier: BSD-3-Clause
# File formats: Gmsh meshes in, VTK fields and SVG pictures out.
add_library(kacanov_io STATIC
  atomic_file.cpp
  body_image.cpp
  body_paths.cpp
  colour_scale.cpp
  deformed_picture.cpp
  gmsh_content.cpp
  gmsh_cursor.cpp
  gmsh_parser.cpp
  gmsh_reader.cpp
  mapped_file.cpp
  node_index.cpp
  png.cpp
  surface.cpp
  svg.cpp
  sweep_picture.cpp
  vtu_writer.cpp)
target_include_directories(kacanov_io PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(kacanov_io PUBLIC kacanov_solver PRIVATE kacanov_warnings)
