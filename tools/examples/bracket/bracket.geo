// A steel angle bracket, lengths in mm: one leg on the wall, one leg out from it, and a fillet between them.
// gmsh -3 -order 2 -format msh22 bracket.geo -o bracket.msh
size = 5;     // element size
fine = 2;     // element size at the fillet
width = 20;   // along y
thick = 5;
high = 40;    // length of the leg on the wall, x from 0 to thick
far = 50;     // length of the leg out from it, z from 0 to thick
bolted = 24;  // the wall supports the bracket above this height
fillet = 4;
seat = 32;    // the ball presses beyond this distance

Point(1) = {0, 0, 0, size};
Point(2) = {seat, 0, 0, size};
Point(3) = {far, 0, 0, size};
Point(4) = {far, 0, thick, size};
Point(5) = {seat, 0, thick, size};
Point(6) = {thick + fillet, 0, thick, fine};
Point(7) = {thick + fillet, 0, thick + fillet, fine};  // centre of the fillet
Point(8) = {thick, 0, thick + fillet, fine};
Point(9) = {thick, 0, high, size};
Point(10) = {0, 0, high, size};
Point(11) = {0, 0, bolted, size};

Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 5};
Line(5) = {5, 6};
Circle(6) = {6, 7, 8};
Line(7) = {8, 9};
Line(8) = {9, 10};
Line(9) = {10, 11};
Line(10) = {11, 1};
Curve Loop(1) = {1, 2, 3, 4, 5, 6, 7, 8, 9, 10};
Plane Surface(1) = {1};
out[] = Extrude {0, width, 0} { Surface{1}; };

// out[0] is the end surface, out[1] the volume, out[2...] the sides in the order of the lines.
Physical Volume("bracket") = {out[1]};
Physical Surface("seat") = {out[5]};
Physical Surface("bolts") = {out[10]};
Physical Surface("back") = {out[11]};
