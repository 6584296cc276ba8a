// SPDX-License-Identifier: BSD-3-Clause
// Half a ring with a shaft, for tests/campaigns/hard_cases: the free end is pressed on the ground.
SetFactory("OpenCASCADE");
Torus(1) = {0,0,1.3, 1, 0.3, Pi};
Cylinder(2) = {-1,0,1.3, 0,-1.5,0, 0.3};
BooleanUnion(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Physical Volume("body") = {3};
Mesh.MeshSizeMax = 0.12;
