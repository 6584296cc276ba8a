// SPDX-License-Identifier: BSD-3-Clause
// A bar with a notch under it, for tests/campaigns/hard_cases: it bends onto a ball.
SetFactory("OpenCASCADE");
Box(1) = {0,0,0, 3,0.5,0.6};
Cylinder(2) = {1.5,-1,0, 0,3,0, 0.35};
BooleanDifference(3) = { Volume{1}; Delete; }{ Volume{2}; Delete; };
Mesh.MeshSizeMax = 0.13;
Physical Volume("body") = {3};
