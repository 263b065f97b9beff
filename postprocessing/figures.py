"""Draws figures 3, 4 and 5 of the paper from exported runs of the square impact.

Figures 3 and 4: maps of sigma11 for RK-DGFEM, ADER-DGFEM and ADER-DGMPM at S1T1 and at S2T2, on one colour scale.
Figure 5: sigma11 and V1 along the bottom line, with a finite-volume reference behind.
Method and degrees are read from each run's summary.json.

usage: figures.py RUN... --out FOLDER [--reference impact_bottom_0.00177.csv] [--time 1.77e-3]
                  [--configuration deformed|reference]
"""

import argparse
import csv
import json
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402
import numpy as np  # noqa: E402

import exported  # noqa: E402

METHODS = {
    "rk-dgfem": ("RK-DGFEM", "#0072b2", (0, (4, 1.5))),
    "ader-dgfem": ("ADER-DGFEM", "#d55e00", "-"),
    "ader-dgmpm": ("ADER-DGMPM", "#111111", (0, (1, 1.2))),
}
MAP_FIGURES = {1: "figure3_map_S1T1", 2: "figure4_map_S2T2"}
PALETTE = "RdBu_r"


def load(folder):
    """A run by its folder: (method, degree, folder)."""
    summary = json.loads((Path(folder) / "summary.json").read_text())
    return summary["method"], int(summary["degree"]), Path(folder)


def by_degree(runs):
    """{degree: {method: folder}}, methods in the order of the paper."""
    found = {}
    for degree in sorted({degree for _, degree, _ in runs}):
        folders = {method: folder for method, d, folder in runs if d == degree}
        found[degree] = {method: folders[method] for method in METHODS if method in folders}
    return found


def sampled_map(run, time, deformed):
    """sigma11 of a run for tripcolor: (time, x, y, triangles, values in GPa)."""
    t, path = exported.step_at(run, time)
    grid = exported.read_grid(path)
    xi, triangles = exported.subdivided(grid)
    x = grid.map(xi)[0]
    if deformed and "displacement" in grid.fields:
        x = x + grid.evaluate("displacement", xi)[..., :2]
    stress = exported.component(grid.evaluate("cauchy_stress", xi), "11")
    return t, x[..., 0].ravel(), x[..., 1].ravel(), triangles, stress.ravel() / 1e9


def draw_maps(runs, degree, time, deformed, out):
    """One row of maps, a method each, on one symmetric colour scale."""
    maps = {method: sampled_map(folder, time, deformed) for method, folder in runs.items()}
    # The scale leaves out the last half percent, which single corners would stretch it by.
    limit = max(np.percentile(abs(values), 99.5) for *_, values in maps.values())
    figure, axes = plt.subplots(
        1, len(maps), figsize=(3.2 * len(maps) + 0.9, 3.7), sharey=True, squeeze=False, layout="compressed"
    )
    for ax, (method, (t, x, y, triangles, values)) in zip(axes[0], maps.items()):
        image = ax.tripcolor(
            x, y, triangles, values, shading="gouraud", cmap=PALETTE, vmin=-limit, vmax=limit, rasterized=True
        )
        ax.set(
            title=f"{METHODS[method][0]}, S{degree}T{degree}, t = {1e3 * t:.4g} ms",
            xlabel="$x_1$ (m)" if deformed else "$X_1$ (m)",
            aspect="equal",
        )
    axes[0, 0].set_ylabel("$x_2$ (m)" if deformed else "$X_2$ (m)")
    figure.colorbar(image, ax=axes, label=r"$\sigma_{11}$ (GPa)", extend="both", pad=0.02)
    return save(figure, out / MAP_FIGURES.get(degree, f"map_S{degree}T{degree}"))


def draw_lines(runs, time, reference, out):
    """sigma11 and V1 along the bottom line: a row per quantity, a column per degree."""
    figure, axes = plt.subplots(
        2, len(runs), figsize=(4.6 * len(runs), 5.6), sharex=True, sharey="row", squeeze=False, layout="constrained"
    )
    rows = (("cauchy_stress_11", "sigma11", 1e9, r"$\sigma_{11}$ (GPa)"), ("velocity_1", "V1", 1.0, "$V_1$ (m/s)"))
    for column, (degree, folders) in enumerate(runs.items()):
        for row, (name, reference_name, unit, label) in enumerate(rows):
            ax = axes[row, column]
            if reference:
                ax.plot(
                    reference["X1"],
                    reference[reference_name] / unit,
                    color="0.65",
                    lw=0.8,
                    label="finite volumes, 450 x 450",
                )
            for method, folder in folders.items():
                line = exported.read_line(folder / "lines" / "bottom.csv", time)
                title, colour, dashes = METHODS[method]
                ax.plot(line["x"], line[name] / unit, color=colour, ls=dashes, lw=1.3, label=title)
            ax.grid(alpha=0.25, lw=0.5)
            if column == 0:
                ax.set_ylabel(label)
        axes[0, column].set_title(f"S{degree}T{degree}")
        axes[1, column].set_xlabel("$X_1$ (m)")
    axes[0, 0].legend(fontsize=8, frameon=False)
    return save(figure, out / "figure5_bottom_line")


def save(figure, stem):
    """Writes PNG and SVG; returns the path of the PNG."""
    png = stem.with_name(stem.name + ".png")
    figure.savefig(png, dpi=160)
    figure.savefig(png.with_suffix(".svg"), dpi=160)
    plt.close(figure)
    return png


def read_columns(path):
    """A CSV file with a header: {column: array}."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return dict(zip(rows[0], np.array(rows[1:], dtype=float).T))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("runs", nargs="+", help="run folders, exported")
    parser.add_argument("--out", default="runs/figures")
    parser.add_argument("--reference", help="CSV with X1, sigma11, V1 along the bottom line")
    parser.add_argument("--time", type=float, default=1.77e-3)
    parser.add_argument("--configuration", choices=["deformed", "reference"], default="deformed")
    args = parser.parse_args()

    out = Path(args.out)
    out.mkdir(parents=True, exist_ok=True)
    runs = by_degree([load(folder) for folder in args.runs])
    reference = read_columns(args.reference) if args.reference else None
    for degree, folders in runs.items():
        print(draw_maps(folders, degree, args.time, args.configuration == "deformed", out))
    print(draw_lines(runs, args.time, reference, out))


if __name__ == "__main__":
    main()
