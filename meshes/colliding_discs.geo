// Two discs of radius 1 m, .02 m apart, the second .5 m higher. h is the cell size.
DefineConstant[ h = {0.25, Name "Cell size"} ];
Mesh.Algorithm = 8;              // Frontal-Delaunay for quads
Mesh.RecombinationAlgorithm = 3; // Blossom full-quad: no triangle stays
xs[] = {0, 2.02};
ys[] = {0, 0.5};
For k In {0:1}
  x = xs[k];
  y = ys[k];
  p = 10 * k;
  Point(p + 1) = {x, y, 0, h};
  Point(p + 2) = {x + 1, y, 0, h};
  Point(p + 3) = {x, y + 1, 0, h};
  Point(p + 4) = {x - 1, y, 0, h};
  Point(p + 5) = {x, y - 1, 0, h};
  Circle(p + 1) = {p + 2, p + 1, p + 3};
  Circle(p + 2) = {p + 3, p + 1, p + 4};
  Circle(p + 3) = {p + 4, p + 1, p + 5};
  Circle(p + 4) = {p + 5, p + 1, p + 2};
  Curve Loop(p + 1) = {p + 1, p + 2, p + 3, p + 4};
  Plane Surface(p + 1) = {p + 1};
  Recombine Surface {p + 1};
EndFor
Physical Curve("first", 1) = {1, 2, 3, 4};
Physical Curve("second", 2) = {11, 12, 13, 14};
Physical Surface("discs", 3) = {1, 11};
Mesh.MshFileVersion = 4.1;
