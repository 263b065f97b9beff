"""Stand-in runs: the layout of a run folder with its export, written by VTK from known polynomials."""

import json
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT / "postprocessing"), str(ROOT / "tests" / "reference")]

import exported  # noqa: E402
import impact  # noqa: E402


def displacement(x):
    """A quadratic displacement [..., 2] and its gradient [..., 2, 2] on [0, 3]^2."""
    a, b = x[..., 0], x[..., 1]
    u = np.stack([-0.01 * a + 0.002 * a * b, 0.004 * b - 0.001 * a * a], axis=-1)
    gradient = np.stack([np.stack([-0.01 + 0.002 * b, 0.002 * a], -1), np.stack([-0.002 * a, 0.004 + 0 * b], -1)], -2)
    return u, gradient


def velocity(x):
    """A quadratic velocity [..., 2]."""
    return np.stack([-200 + 30 * x[..., 0] * x[..., 1], 5 * x[..., 1] ** 2], axis=-1)


def square_corners(cells, distortion=0.0, size=3.0):
    """Corners [cell, 4, 2] of cells x cells quads on a square, inner nodes moved by distortion * h."""
    line = np.linspace(0.0, size, cells + 1)
    nodes = np.stack(np.meshgrid(line, line), axis=-1)
    inner = nodes[1:-1, 1:-1]
    inner += distortion * size / cells * np.random.default_rng(1).uniform(-1, 1, inner.shape)
    return np.stack([nodes[:-1, :-1], nodes[:-1, 1:], nodes[1:, 1:], nodes[1:, :-1]], axis=2).reshape(-1, 4, 2)


def write_step(path, corners, degree):
    """A grid VTU of the fields above (and returns their deformation gradients)."""
    import pyvista

    s = np.linspace(0.0, 1.0, degree + 1)
    xi = np.stack(np.meshgrid(s, s), axis=-1).reshape(-1, 2)
    a, b = xi[:, 0], xi[:, 1]
    x = np.einsum("pa,cak->cpk", np.stack([(1 - a) * (1 - b), a * (1 - b), a * b, (1 - a) * b], 1), corners)
    order = np.argsort(exported.lagrange_order(degree).ravel())
    x = x[:, order].reshape(-1, 2)
    size = (degree + 1) ** 2
    cells = np.hstack([np.full((len(corners), 1), size), np.arange(len(x)).reshape(-1, size)]).ravel()
    kind = exported.VTK_QUAD if degree == 1 else exported.VTK_LAGRANGE_QUADRILATERAL
    grid = pyvista.UnstructuredGrid(cells, np.full(len(corners), kind, np.uint8), np.pad(x, ((0, 0), (0, 1))))
    add_fields(grid.point_data, x)
    grid.save(path, binary=True)


def add_fields(data, x):
    """The exported fields at reference positions x."""
    u, gradient = displacement(x)
    f = np.zeros((len(x), 3, 3))
    f[:, :2, :2], f[:, 2, 2] = np.eye(2) + gradient, 1.0
    stress = np.zeros_like(f)
    stress[:, :2, :2] = impact.cauchy(f[:, :2, :2])
    data["displacement"] = np.pad(u, ((0, 0), (0, 1)))
    data["velocity"] = np.pad(velocity(x), ((0, 0), (0, 1)))
    data["deformation"] = f.reshape(-1, 9)
    data["cauchy_stress"] = stress.reshape(-1, 9)
    data["jacobian"] = np.linalg.det(f)


def write_run(folder, corners, degree, method="ader-dgmpm", times=(3e-4, 1.77e-3)):
    """A run folder with summary, bottom line and export."""
    import pyvista

    export = folder / "export"
    export.mkdir(parents=True)
    (folder / "lines").mkdir()
    (folder / "summary.json").write_text(json.dumps({"method": method, "degree": degree, "time_degree": degree}))
    rows = ["t,s,x,y,cauchy_stress_11,velocity_1"]
    for t in times:
        x = np.linspace(0.0, 3.0, 7)
        line = np.stack([x, 0 * x], -1)
        s11 = impact.cauchy(np.eye(2) + displacement(line)[1])[:, 0, 0]
        rows += [f"{t},{a},{a},0,{b},{c}" for a, b, c in zip(x, s11, velocity(line)[:, 0])]
    (folder / "lines" / "bottom.csv").write_text("\n".join(rows) + "\n")
    centres = corners.mean(axis=1)
    for kind in ("grid", "points"):
        steps = "".join(f'<DataSet timestep="{t}" part="0" file="{kind}_{k}.vtu"/>' for k, t in enumerate(times))
        head = '<?xml version="1.0"?>\n<VTKFile type="Collection" version="0.1">'
        (export / f"{kind}.pvd").write_text(f"{head}<Collection>{steps}</Collection></VTKFile>\n")
        for k in range(len(times)):
            path = export / f"{kind}_{k}.vtu"
            if kind == "grid":
                write_step(path, corners, degree)
            else:
                cloud = pyvista.UnstructuredGrid(
                    np.stack([np.ones(len(centres), int), np.arange(len(centres))], 1).ravel(),
                    np.ones(len(centres), np.uint8),
                    np.pad(centres, ((0, 0), (0, 1))),
                )
                add_fields(cloud.point_data, centres)
                cloud.save(path, binary=True)
    return folder


@pytest.fixture
def run_factory(tmp_path):
    """write_run into a fresh folder."""

    def make(name="run", cells=6, degree=2, distortion=0.0, **options):
        return write_run(tmp_path / name, square_corners(cells, distortion), degree, **options)

    return make
