// A plate of 10 m x 4 m with a curve at half height from the left edge to the middle, which a scene can make a crack.
DefineConstant[ n = {32, Name "Cells over the height (even)"} ];
l = 5.0;
h = 2.0;
For j In {0:2}
  For i In {0:2}
    Point(1 + i + 3 * j) = {i * l, j * h, 0};
  EndFor
  Line(1 + 2 * j) = {1 + 3 * j, 2 + 3 * j};
  Line(2 + 2 * j) = {2 + 3 * j, 3 + 3 * j};
EndFor
For i In {0:2}
  Line(7 + i) = {1 + i, 4 + i};
  Line(10 + i) = {4 + i, 7 + i};
EndFor
Curve Loop(1) = {1, 8, -3, -7};
Curve Loop(2) = {2, 9, -4, -8};
Curve Loop(3) = {3, 11, -5, -10};
Curve Loop(4) = {4, 12, -6, -11};
For k In {1:4}
  Plane Surface(k) = {k};
  Transfinite Surface {k};
  Recombine Surface {k};
EndFor
Transfinite Curve {1:6} = 5 * n / 4 + 1;
Transfinite Curve {7:12} = n / 2 + 1;
Physical Curve("left", 1) = {7, 10};
Physical Curve("right", 2) = {9, 12};
Physical Curve("bottom", 3) = {1, 2};
Physical Curve("top", 4) = {5, 6};
Physical Curve("crack", 5) = {3};
Physical Surface("plate", 6) = {1, 2, 3, 4};
Mesh.MshFileVersion = 4.1;
