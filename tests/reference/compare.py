"""Compares the impact as exported by dgmpm with a reference, by averages over blocks of 0.1 m.

The exported deformation and velocity are evaluated inside each cell by their polynomials, sigma11 by the law
from that F (written here a second time). A cell is sampled at Gauss points where it lies within one block, on a
fine uniform grid of sub-points where it crosses blocks, weighted by det dX/dxi: any mesh will do.

usage: compare.py RUN_OR_EXPORT REFERENCE.npz [--limit 0.02] [--time 3e-4] [--suffix _fv]

REFERENCE.npz holds `s11` and `v1` [iy, ix] as the reference solvers beside this file write them, or the stored
tests/data/impact_blocks30.npz (`s11_0.0003_fv`, ...): then the time is part of the name and --suffix is _fv or _fe.
Prints relative L1 = sum|a - b| / sum|b|; exit code 1 if it is above the limit.
"""

import argparse
import sys
from pathlib import Path

import numpy as np

import impact

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "postprocessing"))
import exported  # noqa: E402


def uniform_rule(n):
    """Midpoints of n x n equal sub-squares of [0,1]^2, with weights."""
    s = (np.arange(n) + 0.5) / n
    return np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2), np.full(n * n, 1.0 / n**2)


def gauss_rule(n):
    """The n x n Gauss-Legendre points of [0,1]^2, with weights."""
    s, w = np.polynomial.legendre.leggauss(n)
    s, w = (s + 1) / 2, w / 2
    return np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2), np.outer(w, w).ravel()


def within_one_block(corners, size, blocks):
    """Whether each cell lies in one block (up to rounding), given its corners [cell, 4, 2]."""
    scaled, slack = corners * (blocks / size), 1e-9
    return np.all(np.floor(scaled.min(axis=1) + slack) >= np.ceil(scaled.max(axis=1) - slack) - 1, axis=1)


def block_averages(grid, fine=16, size=3.0, blocks=30):
    """Block averages of Cauchy sigma11 and v1 of an exported grid: {"s11": [iy, ix], "v1": [iy, ix]}."""
    inside = within_one_block(grid.corners, size, blocks)
    samples = []
    for cells, (xi, w) in ((inside, gauss_rule(grid.degree + 3)), (~inside, uniform_rule(fine))):
        if not cells.any():
            continue
        part = exported.Grid(grid.degree, grid.nodes[cells], {k: f[cells] for k, f in grid.fields.items()}, {})
        x, area = part.map(xi)
        f = part.evaluate("deformation", xi).reshape(*area.shape, 3, 3)[..., :2, :2]
        v1 = part.evaluate("velocity", xi)[..., 0]
        samples.append((x.reshape(-1, 2), (area * w).ravel(), impact.cauchy(f)[..., 0, 0].ravel(), v1.ravel()))
    x, area, s11, v1 = (np.concatenate(parts) for parts in zip(*samples))
    return {
        "s11": impact.block_averages(x, area, s11, size, blocks),
        "v1": impact.block_averages(x, area, v1, size, blocks),
    }


def reference_blocks(path, time, suffix):
    """`s11` and `v1` of a reference file, see the head of this file."""
    data = np.load(path)
    return {name: data[name] if name in data else data[f"{name}_{time:g}{suffix}"] for name in ("s11", "v1")}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("reference")
    parser.add_argument("--limit", type=float, default=0.02)
    parser.add_argument("--time", type=float, default=impact.IMPACT.end)
    parser.add_argument("--suffix", default="_fv")
    parser.add_argument("--fine", type=int, default=16, help="sub-points per direction in cells that cross blocks")
    args = parser.parse_args()

    time, path = exported.step_at(args.run, args.time)
    if abs(time - args.time) > 0.01 * args.time:
        sys.exit(f"{args.run}: the nearest exported step is at {time:g} s, not {args.time:g} s")
    reference = reference_blocks(args.reference, args.time, args.suffix)
    blocks = block_averages(exported.read_grid(path), args.fine)
    errors = {name: impact.relative_l1(blocks[name], reference[name]) for name in reference}
    for name, error in errors.items():
        print(f"{name} relative_l1 {error:.5f}")
    if not max(errors.values()) <= args.limit:
        sys.exit(f"above the limit {args.limit:g}")


if __name__ == "__main__":
    main()
