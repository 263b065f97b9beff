// Two rings of inner radius 30 mm and outer radius 40 mm. The centre of the second is 84 mm to the right and 20 mm above that of the first.
// Cells are of order 2: their edges are curved.
DefineConstant[ nr = {2, Name "Cells through the wall"}, nt = {8, Name "Cells along a quarter"} ];
xs[] = {0, 0.084};
ys[] = {0, 0.02};
surfaces[] = {};
For k In {0:1}
  outside[] = {};
  inside[] = {};
  Point(100 * k + 1) = {xs[k] + 0.03, ys[k], 0};
  wall[] = Extrude {0.01, 0, 0} { Point{100 * k + 1}; Layers{nr}; };
  line = wall[1];
  For quarter In {1:4}
    part[] = Extrude { {0, 0, 1}, {xs[k], ys[k], 0}, Pi/2 } { Curve{line}; Layers{nt}; Recombine; };
    line = part[0];
    surfaces[] += {part[1]};
    outside[] += {Abs(part[2])};
    inside[] += {Abs(part[3])};
  EndFor
  If (k == 0)
    Physical Curve("first", 1) = {outside[]};
    Physical Curve("holes", 2) = {inside[]};
  Else
    Physical Curve("second", 3) = {outside[]};
    Physical Curve("holes", 2) += {inside[]};
  EndIf
EndFor
Physical Surface("rings", 4) = {surfaces[]};
Coherence;
Mesh.ElementOrder = 2;
Mesh.MshFileVersion = 4.1;
