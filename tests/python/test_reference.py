"""The reference solvers and the comparisons themselves: what the program is measured with must be right."""

import json
import os
import subprocess
import sys

import meshio
import numpy as np
import pytest

import compare
import compare_box
import exported
import impact
import skfem_impact
from conftest import ROOT, displacement, square_corners, velocity

REFERENCE = ROOT / "tests" / "reference"
BLOCKS = np.load(ROOT / "tests" / "data" / "impact_blocks30.npz")


def test_stress_is_the_derivative_of_the_energy():
    f = np.eye(2) + 0.2 * np.random.default_rng(0).uniform(-1, 1, (20, 2, 2))
    for i in range(2):
        for a in range(2):
            step = np.zeros((2, 2))
            step[i, a] = 1e-6
            difference = (impact.energy(f + step) - impact.energy(f - step)) / 2e-6
            assert np.allclose(difference, impact.piola(f)[..., i, a], rtol=1e-6, atol=1e3)


def exact_blocks(n=12):
    """Block averages of the stand-in fields by a fine Gauss rule."""
    s, w = np.polynomial.legendre.leggauss(n)
    line = (np.arange(30)[:, None] + (s + 1) / 2).ravel() / 10
    x = np.stack(np.meshgrid(line, line), axis=-1)
    weight = np.outer(np.tile(w, 30), np.tile(w, 30))
    s11 = impact.cauchy(np.eye(2) + displacement(x)[1])[..., 0, 0]
    return {"s11": impact.block_averages(x, weight, s11), "v1": impact.block_averages(x, weight, velocity(x)[..., 0])}


@pytest.mark.parametrize("cells, distortion, limit", [(30, 0.0, 1e-12), (60, 0.0, 1e-12), (31, 0.2, 1e-3)])
def test_block_averages_of_an_exported_grid(run_factory, cells, distortion, limit):
    blocks = compare.block_averages(
        exported.read_grid(exported.step_at(run_factory(cells=cells, distortion=distortion))[1])
    )
    for name, exact in exact_blocks().items():
        assert impact.relative_l1(blocks[name], exact) < limit, name


def test_compare_fails_above_its_limit(run_factory, tmp_path):
    run = run_factory(cells=30)
    np.savez(tmp_path / "same.npz", **exact_blocks())
    command = [sys.executable, REFERENCE / "compare.py", run]
    same = subprocess.run([*command, tmp_path / "same.npz", "--limit", "1e-6"], capture_output=True, text=True)
    assert same.returncode == 0 and same.stdout.startswith("s11 relative_l1 0.00000")
    other = subprocess.run([*command, ROOT / "tests/data/impact_blocks30.npz"], capture_output=True, text=True)
    assert other.returncode == 1 and "above the limit 0.02" in other.stderr


def assert_close_to_stored(npz, limit):
    for name in ("s11", "v1"):
        for kind in ("fv", "fe"):
            assert impact.relative_l1(npz[name], BLOCKS[f"{name}_0.0003_{kind}"]) < limit, (name, kind)


def test_scikit_fem_agrees_with_the_stored_references(tmp_path):
    out = tmp_path / "skfem.npz"
    subprocess.run([sys.executable, REFERENCE / "skfem_impact.py", out], check=True)
    assert_close_to_stored(np.load(out), 0.02)


def test_scikit_fem_converges_to_the_smooth_box():
    errors = []
    for cells in (8, 16):
        basis, u, v = skfem_impact.solve(impact.BOX, cells)
        x = np.moveaxis(np.asarray(basis.global_coordinates()), 0, -1)
        velocity_there = np.moveaxis(np.asarray(basis.interpolate(v)), 0, -1)
        errors.append(
            compare_box.relative_error(x, basis.dx, skfem_impact.deformation(basis.interpolate(u)), velocity_there)
        )
    assert errors[1] < 5e-3 and errors[0] / errors[1] > 3, errors  # F is of order 2 in displacement elements


def test_the_box_reference_has_the_stored_norms_and_value():
    stored = json.loads((ROOT / "tests/data/smooth_box.json").read_text())["values"]
    u, v = compare_box.box_reference()
    s, w = np.polynomial.legendre.leggauss(40)
    x, area = np.stack(np.meshgrid((s + 1) / 2, (s + 1) / 2), axis=-1), np.outer(w, w) / 4
    for name, value in compare_box.norms(area, np.eye(2) + u(x)[1], v(x)[0]).items():
        assert np.isclose(value, stored[name], rtol=1e-9), name
    assert np.isclose(v(np.array([0.25, 0.25]))[0][0], stored["pt(0.25,0.25)/v1"], rtol=1e-9)


@pytest.mark.skipif("DGMPM_DOLFINX_PYTHON" not in os.environ, reason="DOLFINx is not installed")
@pytest.mark.parametrize("cells, distortion", [(30, 0.0), (37, 0.15)])
def test_dolfinx_reads_a_mesh_and_agrees_with_the_stored_references(tmp_path, cells, distortion):
    corners = square_corners(cells, distortion)
    nodes, inverse = np.unique(corners.reshape(-1, 2).round(12), axis=0, return_inverse=True)
    meshio.write(tmp_path / "mesh.xdmf", meshio.Mesh(nodes, [("quad", inverse.reshape(-1, 4))]))
    arguments = [REFERENCE / "dolfinx_impact.py", tmp_path / "mesh.xdmf", tmp_path / "fenics.npz", "--name", "Grid"]
    subprocess.run([os.environ["DGMPM_DOLFINX_PYTHON"], *arguments], check=True)
    assert_close_to_stored(np.load(tmp_path / "fenics.npz"), 0.04)
