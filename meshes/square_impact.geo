// The square of the paper's impact (section 6): 3 m x 3 m, n x n equal cells, lower left corner at the origin.
// Extruded in layers, which places nodes to the last digit (transfinite curves are off by 1e-12).
// gmsh -2 square_impact.geo -setnumber n 60 -o square_impact_60.msh
DefineConstant[ n = {30, Name "Cells per side"} ];
a = 3.0;
Point(1) = {0, 0, 0};
bottom[] = Extrude {a, 0, 0} { Point{1}; Layers{n}; };
square[] = Extrude {0, a, 0} { Curve{bottom[1]}; Layers{n}; Recombine; };
Physical Curve("left", 1) = {Abs(square[3])};
Physical Curve("right", 2) = {Abs(square[2])};
Physical Curve("bottom", 3) = {bottom[1]};
Physical Curve("top", 4) = {square[0]};
Physical Surface("body", 5) = {square[1]};
Mesh.MshFileVersion = 4.1;
