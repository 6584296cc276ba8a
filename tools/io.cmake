# SPDX-License-Identifier: BSD-3-Clause
# File formats: Gmsh meshes in, VTK fields and SVG pictures out.
add_library(kacanov_io STATIC
  formats/atomic_file.cpp
  formats/gmsh_content.cpp
  formats/gmsh_cursor.cpp
  formats/gmsh_parser.cpp
  formats/gmsh_reader.cpp
  formats/mapped_file.cpp
  formats/node_index.cpp
  formats/vtu_writer.cpp
  pictures/body_image.cpp
  pictures/body_paths.cpp
  pictures/colour_scale.cpp
  pictures/deformed_picture.cpp
  pictures/png.cpp
  pictures/surface.cpp
  pictures/svg.cpp
  pictures/sweep_picture.cpp)
target_include_directories(kacanov_io PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_link_libraries(kacanov_io PUBLIC kacanov_solver_internal PRIVATE kacanov_warnings)
