// A quarter of a steel block, lengths in mm, whose top a ball touches at the origin; x = 0 and y = 0 are its planes of
// symmetry.
// gmsh -3 -order 2 -format msh41 -bin ball.geo -o ball.msh
size = 10;     // of the quarter
fine = 0.25;   // of elements under the ball
contact = 1.5; // how far that goes
far = 3;       // of elements elsewhere

Point(1) = {0, 0, 0, fine};
Point(2) = {size, 0, 0, far};
Point(3) = {size, size, 0, far};
Point(4) = {0, size, 0, far};
Point(5) = {contact, 0, 0, fine};
Point(6) = {0, contact, 0, fine};
Line(1) = {1, 5};
Line(2) = {5, 2};
Line(3) = {2, 3};
Line(4) = {3, 4};
Line(5) = {4, 6};
Line(6) = {6, 1};
Circle(7) = {5, 1, 6};
Curve Loop(1) = {1, 7, 6};
Curve Loop(2) = {2, 3, 4, 5, -7};
Plane Surface(1) = {1};
Plane Surface(2) = {2};
Point(12) = {size, 0, -size, far};
Point(13) = {size, size, -size, far};
Point(14) = {0, size, -size, far};
Point(11) = {0, 0, -size, far};
Line(11) = {11, 12};
Line(12) = {12, 13};
Line(13) = {13, 14};
Line(14) = {14, 11};
Line(15) = {1, 11};
Line(16) = {2, 12};
Line(17) = {3, 13};
Line(18) = {4, 14};
Curve Loop(3) = {11, 12, 13, 14};
Plane Surface(3) = {3};
Curve Loop(4) = {1, 2, 16, -11, -15};
Plane Surface(4) = {4};
Curve Loop(5) = {3, 17, -12, -16};
Plane Surface(5) = {5};
Curve Loop(6) = {4, 18, -13, -17};
Plane Surface(6) = {6};
Curve Loop(7) = {5, 6, 15, -14, -18};
Plane Surface(7) = {7};
Surface Loop(1) = {1, 2, 3, 4, 5, 6, 7};
Volume(1) = {1};

Physical Volume("block") = {1};
Physical Surface("top") = {1};
Physical Surface("bottom") = {3};
Physical Surface("front") = {4};
Physical Surface("left") = {7};
