"""Writes the meshes of this folder that `[mesh] rectangle` cannot say: python3 make_meshes.py. They are stored; nothing calls this."""

from math import radians, sin, tan
from pathlib import Path

HERE = Path(__file__).parent


def write(name, nx, ny, place, side, has=lambda i, j: True):
    """An nx x ny grid as MSH 2.2: `place(i, j)` is the node, `side(x, y)` the group of an edge by its middle, `has(i, j)` whether
    the cell is there."""
    cells = [(i, j) for j in range(ny) for i in range(nx) if has(i, j)]
    corners = {c: [(c[0] + a, c[1] + b) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))] for c in cells}
    nodes = {p: k for k, p in enumerate(sorted({p for c in cells for p in corners[c]}, key=lambda p: p[::-1]), 1)}
    edges = {}
    for c in cells:
        for k in range(4):
            edge = (corners[c][k], corners[c][(k + 1) % 4])
            edges.setdefault(frozenset(edge), []).append(edge)
    outer = [e[0] for e in edges.values() if len(e) == 1]
    middle = [[(a + b) / 2 for a, b in zip(place(*p), place(*q))] for p, q in outer]
    groups = sorted({side(*m) for m in middle})
    lines = ["$MeshFormat", "2.2 0 8", "$EndMeshFormat", "$PhysicalNames", str(len(groups) + 1)]
    lines += [f'1 {k} "{g}"' for k, g in enumerate(groups, 1)] + [f'2 {len(groups) + 1} "body"', "$EndPhysicalNames"]
    lines += ["$Nodes", str(len(nodes))]
    lines += [f"{k} {place(*p)[0]:.10g} {place(*p)[1]:.10g} 0" for p, k in nodes.items()]
    lines += ["$EndNodes", "$Elements", str(len(outer) + len(cells))]
    number = 0
    for (p, q), m in zip(outer, middle):
        number += 1
        tag = groups.index(side(*m)) + 1
        lines.append(f"{number} 1 2 {tag} {tag} {nodes[p]} {nodes[q]}")
    for c in cells:
        number += 1
        lines.append(f"{number} 3 2 {len(groups) + 1} {len(groups) + 1} " + " ".join(str(nodes[p]) for p in corners[c]))
    lines.append("$EndElements")
    (HERE / f"{name}.msh").write_text("\n".join(lines) + "\n")


def sides(width, height):
    """The groups of the sides of a rectangle."""

    def side(x, y):
        near = {"left": x, "right": width - x, "bottom": y, "top": height - y}
        return min(near, key=lambda name: near[name])

    return side


def main():
    box = sides(3.0, 3.0)
    # A square whose left side has two groups.
    low = lambda x, y: ("left_low" if y < 1.0 else "left_up") if box(x, y) == "left" else box(x, y)  # noqa: E731
    write("square_two_lefts", 18, 18, lambda i, j: (i / 6, j / 6), low)
    # An L: the upper right quarter of a square is missing. All new edges are "notch".
    notch = lambda x, y: "notch" if min(x, y) > 1.4 and max(x, y) < 2.99 else box(x, y)  # noqa: E731
    write("l_shape", 18, 18, lambda i, j: (i / 6, j / 6), notch, lambda i, j: i < 9 or j < 9)
    # A bar of squares of .1 m, with two columns of slivers 1:50, .002 m wide, at x = .5 and x = 1.
    x = [0.1 * i for i in range(6)] + [0.502] + [0.6 + 0.1 * i for i in range(5)] + [1.002]
    x += [1.1 + 0.1 * i for i in range(20)]
    write("slivers", len(x) - 1, 4, lambda i, j: (x[i], 0.1 * j), sides(3.0, 0.4))
    # A unit square whose inner nodes are moved by up to .2 of a cell, the same each time.
    shift = lambda k, i, j: 0.2 * sin(12.9898 * i + 78.233 * j + k) if 0 < i < 6 and 0 < j < 6 else 0.0  # noqa: E731
    write("distorted", 6, 6, lambda i, j: ((i + shift(0, i, j)) / 6, (j + shift(2, i, j)) / 6), sides(1.0, 1.0))
    # A bar whose cells are chevrons with angles of 20 degrees; the ends are straight.
    reach = 0.1 / tan(radians(20.0))
    ramp = lambda i: min(1.0, i / 6, (30 - i) / 6)  # noqa: E731
    write("chevrons", 30, 6, lambda i, j: (0.1 * i + reach * ramp(i) * (j % 2), 0.1 * j), sides(3.0, 0.6))


main()
