// SPDX-License-Identifier: BSD-3-Clause
// The benchmarks' beam 4 × 1 × 1 as Gmsh (4.8) meshes it: 807,498, 801,216 and 817,941 unknowns.
//   gmsh -3 perf/benchmarks/beam.geo -o tet4.msh
//   gmsh -3 -order 2 -setnumber h 0.0464 perf/benchmarks/beam.geo -o tet10.msh
//   gmsh -3 -setnumber hex 1 -setnumber h 0.068 perf/benchmarks/beam.geo -o hex8.msh     (tetrahedra cut into four hexahedra)
DefineConstant[ h = 0.0226, hex = 0 ];
SetFactory("OpenCASCADE");
Box(1) = {0, 0, 0, 4, 1, 1};
Mesh.MeshSizeMin = h;
Mesh.MeshSizeMax = h;
Mesh.MshFileVersion = 4.1;
Mesh.Binary = 1;
Mesh.SubdivisionAlgorithm = hex ? 2 : 0;
Physical Volume("body") = {1};
