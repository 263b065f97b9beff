// The square of square_impact.geo with an unstructured mesh of quadrilaterals, about n edges per side.
// Delaunay triangles of twice the size, recombined, then divided: frontal meshers give a square rows of squares again.
DefineConstant[ n = {32, Name "Cells per side"} ];
a = 3.0;
Point(1) = {0, 0, 0};
Point(2) = {a, 0, 0};
Point(3) = {a, a, 0};
Point(4) = {0, a, 0};
Line(1) = {1, 2};
Line(2) = {2, 3};
Line(3) = {3, 4};
Line(4) = {4, 1};
Curve Loop(1) = {1, 2, 3, 4};
Plane Surface(1) = {1};
Mesh.MeshSizeExtendFromBoundary = 0;
Mesh.MeshSizeMin = 2 * a / n;
Mesh.MeshSizeMax = 2 * a / n;
Mesh.Algorithm = 5;              // Delaunay
Mesh.RecombinationAlgorithm = 1; // Blossom
Mesh.SubdivisionAlgorithm = 1;   // all quadrilaterals
Recombine Surface {1};
Physical Curve("left", 1) = {4};
Physical Curve("right", 2) = {2};
Physical Curve("bottom", 3) = {1};
Physical Curve("top", 4) = {3};
Physical Surface("body", 5) = {1};
Mesh.MshFileVersion = 4.1;
