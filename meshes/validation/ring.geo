// A ring of inner radius 30 mm and outer radius 40 mm. Cells are of order 2: their edges are curved.
DefineConstant[ nr = {2, Name "Cells through the wall"}, nt = {8, Name "Cells along a quarter"} ];
around[] = {};
surfaces[] = {};
Point(1) = {0.03, 0, 0};
wall[] = Extrude {0.01, 0, 0} { Point{1}; Layers{nr}; };
line = wall[1];
For quarter In {1:4}
  part[] = Extrude { {0, 0, 1}, {0, 0, 0}, Pi/2 } { Curve{line}; Layers{nt}; Recombine; };
  line = part[0];
  surfaces[] += {part[1]};
  around[] += {Abs(part[2]), Abs(part[3])};
EndFor
Physical Curve("around", 1) = {around[]};       // both sides
Physical Surface("ring", 2) = {surfaces[]};
Coherence;
Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
