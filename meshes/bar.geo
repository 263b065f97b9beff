// A bar of 3 m x 0.1 m, nx x ny equal cells: one-dimensional waves in a two-dimensional code.
DefineConstant[ nx = {60, Name "Cells along the bar"}, ny = {2, Name "Cells across the bar"} ];
a = 3.0;
b = 0.1;
Point(1) = {0, 0, 0};
bottom[] = Extrude {a, 0, 0} { Point{1}; Layers{nx}; };
bar[] = Extrude {0, b, 0} { Curve{bottom[1]}; Layers{ny}; Recombine; };
Physical Curve("left", 1) = {Abs(bar[3])};
Physical Curve("right", 2) = {Abs(bar[2])};
Physical Curve("bottom", 3) = {bottom[1]};
Physical Curve("top", 4) = {bar[0]};
Physical Surface("body", 5) = {bar[1]};
Mesh.MshFileVersion = 4.1;
