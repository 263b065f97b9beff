// The elastic beam of Turek and Hron's structural tests: .02 m thick, its free end at x = .6 m, its other end on a cylinder of radius
// .05 m about (.2, .2). The end at the cylinder is an arc, so the beam is .35 m long in the middle and .35101 m at its sides.
DefineConstant[ nx = {35, Name "Cells along the beam"}, ny = {2, Name "Cells across the beam (even)"} ];
x = 0.2 + Sqrt(0.05^2 - 0.01^2);
Point(1) = {0.2, 0.2, 0};
Point(2) = {x, 0.19, 0};
Point(3) = {0.6, 0.19, 0};
Point(4) = {0.6, 0.21, 0};
Point(5) = {x, 0.21, 0};
Circle(1) = {2, 1, 5};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {5, 4};
Curve Loop(1) = {2, 3, -4, -1};
Plane Surface(1) = {1};
Transfinite Curve {2, 4} = nx + 1;
Transfinite Curve {1, 3} = ny + 1;
Transfinite Surface {1};
Recombine Surface {1};
Physical Curve("root", 1) = {1};
Physical Curve("sides", 2) = {2, 3, 4};
Physical Surface("beam", 3) = {1};
Mesh.MshFileVersion = 4.1;
