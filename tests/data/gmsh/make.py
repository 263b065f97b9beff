"""Writes the MSH files of this folder with Gmsh's Python module: `python make.py` in this folder (Gmsh 4.15)."""

import gmsh


def start():
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)


def save(files, **options):
    for name, value in options.items():
        gmsh.option.setNumber("Mesh." + name, value)
    for name, version in files.items():
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(name + ".msh")
    gmsh.finalize()


def rectangle(x=0, y=0, cells=(2, 2), recombine=True):
    """The unit square at (x, y): its curves (bottom, right, top, left) and its surface."""
    geo = gmsh.model.geo
    points = [geo.addPoint(*p, 0) for p in [(x, y), (x + 1, y), (x + 1, y + 1), (x, y + 1)]]
    lines = [geo.addLine(points[i], points[(i + 1) % 4]) for i in range(4)]
    surface = geo.addPlaneSurface([geo.addCurveLoop(lines)])
    for i, line in enumerate(lines):
        geo.mesh.setTransfiniteCurve(line, cells[i % 2] + 1)
    geo.mesh.setTransfiniteSurface(surface)
    if recombine:
        geo.mesh.setRecombine(2, surface)
    geo.synchronize()
    return lines, surface


def square(edges=4, **how):
    """One meshed square with groups `edge` (of its first curves) and `body`."""
    start()
    lines, surface = rectangle(**how)
    gmsh.model.addPhysicalGroup(1, lines[:edges], 1, "edge")
    gmsh.model.addPhysicalGroup(2, [surface], 2, "body")
    gmsh.model.mesh.generate(2)
    return surface


def pair(left, right):
    """Two squares side by side that share no curve."""
    start()
    a, s = rectangle(cells=left)
    b, t = rectangle(x=1, cells=right)
    gmsh.model.addPhysicalGroup(1, [a[0], a[2], a[3], b[0], b[1], b[2]], 1, "edge")
    gmsh.model.addPhysicalGroup(2, [s, t], 2, "body")
    gmsh.model.mesh.generate(2)


start()
gmsh.open("two_surfaces.geo")
gmsh.model.mesh.generate(2)
for kind, binary in (("ascii", 0), ("binary", 1)):
    for name, version in (("22", 2.2), ("41", 4.1)):
        gmsh.option.setNumber("Mesh.Binary", binary)
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(f"two_surfaces_{name}_{kind}.msh")
gmsh.finalize()

square(recombine=False)
save({"triangles": 4.1})

square()
gmsh.model.mesh.setOrder(2)
save({"order_2": 2.2})

square(edges=3)
save({"untagged_edge": 4.1})

square(cells=(4, 4))
gmsh.model.mesh.partition(2)
save({"partitioned_41": 4.1, "partitioned_22": 2.2})

gmsh.model.addPhysicalGroup(2, [square()], 3, "steel")
save({"two_groups_41": 4.1, "two_groups_22": 2.2})

start()
lines, _ = rectangle()
_, other = rectangle(x=2)
gmsh.model.addPhysicalGroup(1, lines, 1, "edge")
gmsh.model.addPhysicalGroup(2, [other], 3, "steel")
gmsh.model.mesh.generate(2)
save({"no_group_41": 4.1, "no_group_22": 2.2}, SaveAll=1)

start()
gmsh.model.addPhysicalGroup(1, rectangle()[0], 1, "edge")
gmsh.model.mesh.generate(2)
save({"no_surface_group": 4.1}, SaveAll=1)

start()
_, surface = rectangle()
gmsh.model.geo.extrude([(2, surface)], 0, 0, 1, [1], recombine=True)
gmsh.model.geo.synchronize()
gmsh.model.addPhysicalGroup(3, [1], 1, "block")
gmsh.model.addPhysicalGroup(2, [surface], 2, "body")
gmsh.model.mesh.generate(3)
save({"solid": 4.1})

pair((2, 2), (2, 2))
save({"unmerged": 4.1})

pair((1, 1), (2, 2))
gmsh.model.mesh.removeDuplicateNodes()
save({"hanging_node": 4.1})

for name, binary in (("parametric_22", 0), ("parametric_22_binary", 1)):
    start()
    lines, surface = rectangle(cells=(3, 3))
    for tag, (line, side) in enumerate(zip(lines, ("bottom", "right", "top", "left")), 1):
        gmsh.model.addPhysicalGroup(1, [line], tag, side)
    gmsh.model.addPhysicalGroup(2, [surface], 5, "body")
    gmsh.model.mesh.generate(2)
    save({name: 2.2}, SaveParametric=1, Binary=binary)

start()
lines, surface = rectangle(cells=(3, 3))
gmsh.model.addPhysicalGroup(1, lines, 1, "a")
gmsh.model.addPhysicalGroup(2, [surface], 2, "body")
gmsh.model.mesh.generate(2)
save({"save_all_22": 2.2}, SaveAll=1)

start()
lines, surface = rectangle()
gmsh.model.geo.translate([(2, surface)], 0, 0, 1)
gmsh.model.geo.synchronize()
gmsh.model.addPhysicalGroup(1, lines, 1, "edge")
gmsh.model.addPhysicalGroup(2, [surface], 2, "body")
gmsh.model.mesh.generate(2)
save({"out_of_plane": 4.1})

square()
save({"version_40": 4.0, "version_10": 1.0})

square()
gmsh.model.mesh.reverse()
save({"clockwise": 4.1})

middle = gmsh.model.mesh.getNodes(2, square())[0][0]
gmsh.model.mesh.setNode(int(middle), [-0.2, -0.2, 0], [])
save({"inverted": 4.1})

# A quarter of an annulus of radii 1 and 2 m, 2 x 2 cells: its arcs are curved edges of order 2.
for kind, incomplete, files in (
    ("9", 0, {"annulus_22": 2.2, "annulus_41": 4.1}),
    ("8", 1, {"annulus_8": 4.1}),
):
    start()
    geo = gmsh.model.geo
    centre = geo.addPoint(0, 0, 0)
    a, b, c, d = [geo.addPoint(*p, 0) for p in [(1, 0), (2, 0), (0, 2), (0, 1)]]
    curves = [geo.addLine(a, b), geo.addCircleArc(b, centre, c), geo.addLine(c, d), geo.addCircleArc(d, centre, a)]
    surface = geo.addPlaneSurface([geo.addCurveLoop(curves)])
    for curve in curves:
        geo.mesh.setTransfiniteCurve(curve, 3)
    geo.mesh.setTransfiniteSurface(surface)
    geo.mesh.setRecombine(2, surface)
    geo.synchronize()
    for tag, (name, of) in enumerate({"sides": [0, 2], "outer": [1], "inner": [3]}.items(), 1):
        gmsh.model.addPhysicalGroup(1, [curves[k] for k in of], tag, name)
    gmsh.model.addPhysicalGroup(2, [surface], 4, "body")
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", incomplete)
    gmsh.model.mesh.generate(2)
    gmsh.model.mesh.setOrder(2)
    # Version 2.2 in binary.
    for name, version in files.items():
        gmsh.option.setNumber("Mesh.Binary", int(version == 2.2))
        gmsh.option.setNumber("Mesh.MshFileVersion", version)
        gmsh.write(name + ".msh")
    gmsh.finalize()

square()
gmsh.model.mesh.setOrder(3)
save({"order_3": 4.1})
