// A plate of 2 m x 2 m with a round hole of radius 0.3 m in its middle, unstructured quadrilaterals.
// h is the size at the edges of the plate, h / 2 that at the hole.
DefineConstant[ h = {0.08, Name "Cell size at the edges"} ];
a = 2.0;
r = 0.3;
Point(1) = {0, 0, 0, h};
Point(2) = {a, 0, 0, h};
Point(3) = {a, a, 0, h};
Point(4) = {0, a, 0, h};
Point(5) = {a / 2, a / 2, 0, h};
Point(6) = {a / 2 + r, a / 2, 0, h / 2};
Point(7) = {a / 2, a / 2 + r, 0, h / 2};
Point(8) = {a / 2 - r, a / 2, 0, h / 2};
Point(9) = {a / 2, a / 2 - r, 0, h / 2};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Circle(5) = {6, 5, 7};
Circle(6) = {7, 5, 8};
Circle(7) = {8, 5, 9};
Circle(8) = {9, 5, 6};
Curve Loop(1) = {1, 2, 3, 4};
Curve Loop(2) = {5, 6, 7, 8};
Plane Surface(1) = {1, 2};
Mesh.Algorithm = 8;              // Frontal-Delaunay for quads
Mesh.RecombinationAlgorithm = 3; // Blossom full-quad: no triangle stays
Recombine Surface {1};
Physical Curve("left", 1) = {4};
Physical Curve("right", 2) = {2};
Physical Curve("bottom", 3) = {1};
Physical Curve("top", 4) = {3};
Physical Curve("hole", 5) = {5, 6, 7, 8};
Physical Surface("body", 6) = {1};
Mesh.MshFileVersion = 4.1;
