// A quarter of a thick ring: inner radius .08 m, outer radius .10 m, about the origin. Cells through the wall and along the arc:
DefineConstant[ nr = {6, Name "Cells through the wall"}, nt = {30, Name "Cells along the quarter"} ];
Point(1) = {0.08, 0, 0};
wall[] = Extrude {0.02, 0, 0} { Point{1}; Layers{nr}; };
ring[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi/2 } { Curve{wall[1]}; Layers{nt}; Recombine; };
Physical Curve("bottom", 1) = {wall[1]};        // on the x axis
Physical Curve("left", 2) = {ring[0]};          // on the y axis
Physical Curve("inner", 3) = {Abs(ring[3])};
Physical Curve("outer", 4) = {Abs(ring[2])};
Physical Surface("body", 5) = {ring[1]};
Mesh.MshFileVersion = 4.1;
