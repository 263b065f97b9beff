"""A picture of any exported run without ParaView: one component of one field, on the deformed shape.

usage: render.py RUN [--field cauchy_stress] [--component 11] [--time T] [--warp 1]
                 [--points] [--edges] [--dpi 160] [--out FILE.png]
"""

import argparse
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402

import exported  # noqa: E402

LABELS = {
    "velocity": (r"$v$", "m/s", 1.0),
    "displacement": (r"$u$", "mm", 1e-3),
    "cauchy_stress": (r"$\sigma$", "GPa", 1e9),
    "piola": (r"$P$", "GPa", 1e9),
    "von_mises": (r"$\sigma_{vM}$", "GPa", 1e9),
    "deformation": (r"$F$", "-", 1.0),
    "jacobian": (r"$J$", "-", 1.0),
}


def warped(grid, xi, warp):
    """Positions X + warp u of parent points in all cells, [cell, point, 2]."""
    x = grid.map(xi)[0]
    if warp and "displacement" in grid.fields:
        x = x + warp * grid.evaluate("displacement", xi)[..., :2]
    return x


def outline(grid, warp):
    """The edges of all cells as polylines, [cell, point, 2]."""
    s = np.linspace(0.0, 1.0, 2 * grid.degree + 1)
    zero, one = np.zeros_like(s), np.ones_like(s)
    loop = np.concatenate([np.stack(p, axis=1) for p in ((s, zero), (one, s), (s[::-1], one), (zero, s[::-1]))])
    return warped(grid, loop, warp)


def default_component(name, components):
    """What is drawn where nothing is chosen: 11 of a tensor, the size of a vector, a scalar itself."""
    return {9: "11", 3: "norm", 1: ""}[components]


def draw(
    run, field="cauchy_stress", component=None, time=None, warp=1.0, points=False, edges=False, dpi=160, out="view.png"
):
    """Draws one step of a run into a PNG (or what the name of the file says)."""
    t, path = exported.step_at(run, time)
    grid = exported.read_grid(path)
    if field not in grid.fields:
        raise SystemExit(f"{path}: no field {field!r}; there are {', '.join(sorted(grid.fields))}")
    component = default_component(field, grid.fields[field].shape[-1]) if component is None else component
    symbol, unit, scale = LABELS.get(field, (field, "", 1.0))

    xi, triangles = exported.subdivided(grid)
    x = warped(grid, xi, warp)
    values = exported.component(grid.evaluate(field, xi), component, field).ravel() / scale
    low, high = np.percentile(values, [0.25, 99.75])
    signed = low < 0 < high
    if signed:
        low, high = -max(-low, high), max(-low, high)

    extent = np.ptp(x.reshape(-1, 2), axis=0)
    width = 6.0 * float(np.clip(extent[0] / extent[1], 0.6, 3.0)) if extent[1] else 12.0
    figure, ax = plt.subplots(figsize=(width + 1.2, 6.0), layout="constrained")
    image = ax.tripcolor(
        x[..., 0].ravel(), x[..., 1].ravel(), triangles, values,
        shading="gouraud", cmap="RdBu_r" if signed else "viridis", vmin=low, vmax=high, rasterized=True,
    )  # fmt: skip
    if edges:
        ax.add_collection(LineCollection(outline(grid, warp), colors="k", linewidths=0.25, alpha=0.6))
    if points:
        cloud = exported.read_points(exported.step_at(run, time, "points")[1])
        position = cloud["points"] + (warp * cloud["displacement"][:, :2] if "displacement" in cloud else 0.0)
        ax.scatter(*position.T, s=0.6, c="k", linewidths=0, alpha=0.7)
    label = symbol + (f"$_{{{component}}}$" if component.isdigit() else "") + (f" ({unit})" if unit else "")
    figure.colorbar(image, ax=ax, label=label, extend="both", shrink=0.9)
    ax.set(aspect="equal", xlabel="$x_1$ (m)", ylabel="$x_2$ (m)", title=f"t = {1e3 * t:.4g} ms")
    Path(out).parent.mkdir(parents=True, exist_ok=True)
    figure.savefig(out, dpi=dpi)
    plt.close(figure)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("run")
    parser.add_argument("--field", default="cauchy_stress")
    parser.add_argument("--component", help="11, 12, .. of a tensor; 1, 2 or norm of a vector")
    parser.add_argument("--time", type=float, help="the last step by default")
    parser.add_argument("--warp", type=float, default=1.0, help="factor on the displacement, 0 for the initial shape")
    parser.add_argument("--points", action="store_true", help="draw the material points")
    parser.add_argument("--edges", action="store_true", help="draw the edges of the cells")
    parser.add_argument("--dpi", type=int, default=160)
    parser.add_argument("--out", default="view.png")
    args = parser.parse_args()
    draw(**vars(args))
    print(args.out)


if __name__ == "__main__":
    main()
