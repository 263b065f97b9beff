// A bar of length a and one cell height in two materials that meet at x0, n equal cells: n x0 / a must be whole.
// gmsh -2 riemann.geo -setnumber n 240 -o riemann_240.msh
DefineConstant[ n = {120, Name "Cells along the bar"} ];
a = 3.0;
x0 = 1.5;
Point(1) = {0, 0, 0};
left[] = Extrude {x0, 0, 0} { Point{1}; Layers{n * x0 / a}; };
right[] = Extrude {a - x0, 0, 0} { Point{left[0]}; Layers{n - n * x0 / a}; };
first[] = Extrude {0, a / n, 0} { Curve{left[1]}; Layers{1}; Recombine; };
second[] = Extrude {0, a / n, 0} { Curve{right[1]}; Layers{1}; Recombine; };
Physical Curve("left", 1) = {Abs(first[3])};
Physical Curve("right", 2) = {Abs(second[2])};
Physical Curve("bottom", 3) = {left[1], right[1]};
Physical Curve("top", 4) = {first[0], second[0]};
Physical Surface("steel", 5) = {first[1]};
Physical Surface("aluminium", 6) = {second[1]};
Mesh.MshFileVersion = 4.1;
