// SPDX-License-Identifier: BSD-3-Clause
// An uneven cube of tet10: gmsh -3 -order 2 -format msh41 uneven_cube.geo
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 1, 1, 1};
Mesh.MeshSizeMax = 0.55; Mesh.MeshSizeMin = 0.1;
Mesh.ElementOrder = 2;
Physical Surface("left") = Surface In BoundingBox {-0.001,-0.001,-0.001, 0.001,1.001,1.001};
Physical Surface("right") = Surface In BoundingBox {0.999,-0.001,-0.001, 1.001,1.001,1.001};
Physical Surface("front") = Surface In BoundingBox {-0.001,-0.001,-0.001, 1.001,0.001,1.001};
Physical Surface("back") = Surface In BoundingBox {-0.001,0.999,-0.001, 1.001,1.001,1.001};
Physical Surface("bottom") = Surface In BoundingBox {-0.001,-0.001,-0.001, 1.001,1.001,0.001};
Physical Surface("top") = Surface In BoundingBox {-0.001,-0.001,0.999, 1.001,1.001,1.001};
Physical Volume("body") = {1};
// Different sizes at the corners make it uneven.
MeshSize { PointsOf{ Volume{1}; } } = 0.55;
MeshSize { 1 } = 0.25;
MeshSize { 7 } = 0.35;
