// The upper half of a disc of radius 1 m about the origin, of six blocks of n x n cells. Edges are straight: the disc is a polygon.
DefineConstant[ n = {4, Name "Cells along a side of each block"} ];
a = 0.55;                     // where the inner blocks end on the axes
b = 0.45;                     // their corners on the diagonals
Point(1) = {0, 0, 0};
Point(2) = {0, a, 0};
Point(3) = {0, 1, 0};
For side In {0:1}
  s = 1 - 2 * side;           // the right side, then the left one
  p = 10 * (side + 1);
  Point(p + 1) = {s * a, 0, 0};
  Point(p + 2) = {s, 0, 0};
  Point(p + 3) = {s * b, b, 0};
  Point(p + 4) = {s * Cos(Pi/4), Sin(Pi/4), 0};
  Line(p + 1) = {1, p + 1};
  Line(p + 2) = {p + 1, p + 2};
  Line(p + 3) = {p + 1, p + 3};
  Line(p + 4) = {p + 3, 2};
  Line(p + 5) = {p + 3, p + 4};
  Circle(p + 6) = {p + 2, 1, p + 4};
  Circle(p + 7) = {p + 4, 1, 3};
EndFor
Line(1) = {2, 1};
Line(2) = {2, 3};
For side In {0:1}
  p = 10 * (side + 1);
  Curve Loop(p + 1) = {p + 1, p + 3, p + 4, 1};
  Curve Loop(p + 2) = {p + 2, p + 6, -(p + 5), -(p + 3)};
  Curve Loop(p + 3) = {p + 5, p + 7, -2, -(p + 4)};
  For k In {1:3}
    Plane Surface(p + k) = {p + k};
    Transfinite Surface {p + k};
    Recombine Surface {p + k};
  EndFor
EndFor
Transfinite Curve {1, 2, 11:17, 21:27} = n + 1;
Physical Curve("bottom", 1) = {11, 12, 21, 22}; // on the x axis
Physical Curve("rim", 2) = {16, 17, 26, 27};
Physical Surface("body", 3) = {11, 12, 13, 21, 22, 23};
Mesh.MshFileVersion = 4.1;
