"""Reads a run by tools/dgmpm_io.py and compares with what the run itself says, with meshio and, where it is there, with DOLFINx.

Usage: run_folder.py RUN      Prints one line a check; exits with 1 if any failed.
"""

import logging
import sys
from pathlib import Path

import h5py
import numpy as np

sys.path[:0] = [str(Path(__file__).resolve().parents[2] / "tools")]
import dgmpm_io  # noqa: E402

FAILED = []
RANDOM = np.random.default_rng(1)


def check(what, good):
    print(("ok    " if good else "FAIL  ") + what)
    if not good:
        FAILED.append(what)


def near(found, expected, limit, size=None):
    """Whether numbers differ by at most `limit` of the largest that is expected (or of `size`)."""
    found, expected = np.asarray(found), np.asarray(expected)
    return np.abs(found - expected).max() <= limit * (np.abs(expected).max() if size is None else size)


def kinetic(state):
    """int |p|^2 / (2 rho0) dX."""
    return 0.5 * np.einsum("cn,ckn,c->", state.masses, state.field("momentum") ** 2, 1 / state.densities)


def check_ledger(run, states):
    """Totals of each snapshot that has a row of its step in the ledger: sums of some thousand terms, rounding only."""
    ledger, seen = run.table(), 0
    for state in states:
        for row in ledger[ledger["step"] == state.step]:
            seen += 1
            momentum = [row["momentum_1"], row["momentum_2"]]
            check(f"step {state.step}: kinetic energy", near(kinetic(state), row["kinetic_energy"], 1e-12))
            size = np.einsum("cn,ckn->", state.masses, np.abs(state.field("momentum")))
            check(f"step {state.step}: momentum", near(state.integral("momentum"), momentum, 1e-12, size))
            check(f"step {state.step}: no J below that of the ledger", state.field("jacobian").min() >= row["min_j"])
    check(f"{seen} rows of the ledger belong to a snapshot", seen > 0)


def check_places(state):
    """Fields at points X are those at the parent coordinates that the points were made from."""
    cells, xi = RANDOM.integers(len(state.u), size=30), RANDOM.random((30, 2))
    points = np.array([state.mesh.positions(at[None])[cell, 0] for cell, at in zip(cells, xi)])
    found, parents = state.mesh.locate(points)
    check("points are found in their cells", np.array_equal(found, cells) and near(parents, xi, 1e-12))
    values = np.array([state.in_cells("deformation", at[None])[cell, 0] for cell, at in zip(cells, xi)])
    check("fields at points", near(state.at(points, "deformation"), values, 1e-12))
    try:
        state.mesh.locate([[1e9, 0.0]])
        check("a point outside is an error", False)
    except ValueError as why:
        check("a point outside is an error", "lies in no cell" in str(why))
    return points


def check_meshio(state, folder):
    """The mesh of meshio comes back from a file, with the fields at the corners."""
    try:
        import meshio
    except ImportError:
        return
    state.to_meshio().write(folder / "dgmpm_io.vtu")
    back = meshio.read(folder / "dgmpm_io.vtu")
    corners = state.in_cells("velocity", np.array([[0.0, 0], [1, 0], [1, 1], [0, 1]])).reshape(-1, 2)
    # VTU has vectors of three numbers.
    check("meshio: velocity at the corners", np.array_equal(back.point_data["velocity"][:, :2], corners))
    check("meshio: groups of cells", np.array_equal(back.cell_data["group"][0], state.mesh.cell_group))


def check_dolfinx(state, points):
    """Functions of DOLFINx are the same polynomials: their norms, the kinetic energy, and values at points."""
    try:
        import ufl
        from dolfinx import fem
    except ImportError:
        return
    logging.disable(logging.INFO)  # the compiler's command lines
    cells, parents = state.mesh.locate(points)
    for name in ("velocity", "deformation", "jacobian"):
        function = state.function(name)
        # On cells that are no parallelograms DOLFINx takes a quadrature of its own: f^2 J is a polynomial, for which it is exact. On curved
        # cells the sum over the nodes is not, and DOLFINx is to take the same N + 1 points a direction.
        curved = state.mesh.bulges is not None
        dx = ufl.dx(metadata={"quadrature_degree": 2 * state.degree + 1}) if curved else ufl.dx
        norm = np.sqrt(fem.assemble_scalar(fem.form(ufl.inner(function, function) * dx)))
        check(f"DOLFINx: norm of {name}", near(norm, np.sqrt((state.norm(name) ** 2).sum()), 1e-10))
        mesh = function.function_space.mesh
        there = np.argsort(mesh.topology.original_cell_index)[cells]
        at = np.pad(points, ((0, 0), (0, 1)))
        values = function.eval(at, there).reshape(len(points), -1)
        check(f"DOLFINx: {name} at points", near(values, state.at(points, name), 1e-12))


def check_page(folder):
    """docs/files.md names all datasets of a snapshot with their number of axes."""
    page = (Path(__file__).resolve().parents[2] / "docs" / "files.md").read_text()
    rows = [line.split(" | ") for line in page.splitlines() if line.startswith("| `")]
    shapes = {name.strip("| `"): row[1] for row in rows if len(row) == 3 for name in row[0].split(", ")}
    with h5py.File(sorted((folder / "snapshots").glob("*.h5"))[-1]) as file:
        for name, data in file.items():
            shape = shapes.get(name, "")
            axes = 1 if shape == "one number" else shape.count(",") + 1
            check(f"docs/files.md has `{name}` with {axes} axes", shape and (data.ndim == axes or data.size == 1))


def main(folder):
    run = dgmpm_io.Run(folder)
    states = list(run.snapshots())
    check(f"{len(states)} snapshots", len(states) > 1 and states[0].time < states[-1].time)
    check_ledger(run, states)
    check_page(run.folder)
    points = check_places(states[-1])
    check_meshio(states[-1], run.folder)
    check_dolfinx(states[-1], points)
    print(f"{run.folder.name}: {len(FAILED)} failed")
    return 1 if FAILED else 0


if __name__ == "__main__":
    assert len(sys.argv) == 2, __doc__
    sys.exit(main(Path(sys.argv[1])))
