// SPDX-License-Identifier: BSD-3-Clause
// The benchmarks' beam 4 × 1 × 1 as Gmsh meshes it, some 812,000 unknowns:
//   gmsh -3 perf/beam.geo -o tet4.msh
//   gmsh -3 -order 2 -setnumber h 0.0475 perf/beam.geo -o tet10.msh
//   gmsh -3 -setnumber hex 1 -setnumber h 0.047 perf/beam.geo -o hex8.msh     (tetrahedra cut into four hexahedra)
DefineConstant[ h = 0.0255, hex = 0 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 1, 1};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 1;
Mesh.SubdivisionAlgorithm = hex ? 2 : 0;
Physical Volume("body") = {1};
