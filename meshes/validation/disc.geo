// A quarter of a disc of radius 1 m about the origin, of three blocks of n x n cells of order 2: the rim is curved.
DefineConstant[ n = {6, Name "Cells along a side of each block"} ];
a = 0.55;                     // where the inner block ends on the axes
b = 0.45;                     // its corner on the diagonal
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {1, 0, 0};
Point(4) = {b, b, 0};
Point(5) = {Cos(Pi/4), Sin(Pi/4), 0};
Point(6) = {0, a, 0};
Point(7) = {0, 1, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {2, 4};
Line(4) = {4, 6};
Line(5) = {6, 1};
Line(6) = {4, 5};
Line(7) = {6, 7};
Circle(8) = {3, 1, 5};
Circle(9) = {5, 1, 7};
Curve Loop(1) = {1, 3, 4, 5};
Curve Loop(2) = {2, 8, -6, -3};
Curve Loop(3) = {6, 9, -7, -4};
For k In {1:3}
  Plane Surface(k) = {k};
  Transfinite Surface {k};
  Recombine Surface {k};
EndFor
Transfinite Curve {1:9} = n + 1;
Physical Curve("bottom", 1) = {1, 2};           // on the x axis
Physical Curve("left", 2) = {5, 7};             // on the y axis
Physical Curve("rim", 3) = {8, 9};
Physical Surface("body", 4) = {1, 2, 3};
Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
