"""The reader of exported grids and what is drawn from it, on stand-in runs with known fields."""

import subprocess
import sys

import numpy as np
import pytest

import exported
from conftest import ROOT, displacement, velocity


@pytest.mark.parametrize("degree", [1, 2, 3, 4])
def test_node_order_is_that_of_vtk(degree):
    import vtk

    quad = vtk.vtkLagrangeQuadrilateral()
    quad.SetOrder(degree, degree)
    expected = [[quad.PointIndexFromIJK(i, j, 0) for i in range(degree + 1)] for j in range(degree + 1)]
    assert np.array_equal(exported.lagrange_order(degree), expected)


@pytest.mark.parametrize("degree", [2, 3, 4])
def test_polynomials_of_the_degree_are_reproduced_inside_cells(run_factory, degree):
    grid = exported.read_grid(exported.step_at(run_factory(degree=degree))[1])
    xi = np.random.default_rng(0).random((5, 2))
    x, area = grid.map(xi)
    assert np.allclose(area, 0.25)
    assert np.allclose(grid.evaluate("displacement", xi)[..., :2], displacement(x)[0], atol=1e-14)
    assert np.allclose(grid.evaluate("velocity", xi)[..., :2], velocity(x), rtol=1e-13)


def test_area_of_distorted_cells_adds_up(run_factory):
    grid = exported.read_grid(exported.step_at(run_factory(distortion=0.2))[1])
    xi, w = np.array([[0.5, 0.5]]), 1.0  # det is linear in xi: one point is exact
    assert np.isclose(np.sum(grid.map(xi)[1] * w), 9.0, rtol=1e-14)


def test_steps_and_lines_are_chosen_by_time(run_factory):
    run = run_factory()
    assert exported.step_at(run, 2.9e-4)[0] == 3e-4
    assert exported.step_at(run / "export")[0] == 1.77e-3
    assert set(exported.read_line(run / "lines" / "bottom.csv", 1e-4)["t"]) == {3e-4}


def test_an_unknown_component_names_the_known_ones():
    with pytest.raises(ValueError, match="'11', '12'"):
        exported.component(np.zeros((4, 9)), "13", "piola")


def script(*arguments):
    return subprocess.run(
        [sys.executable, *map(str, arguments)], cwd=ROOT, check=True, capture_output=True, text=True
    ).stdout


def test_figures_are_drawn(run_factory, tmp_path):
    runs = [
        run_factory(f"{method}-{degree}", degree=degree, method=method)
        for degree in (1, 2)
        for method in ("ader-dgmpm", "rk-dgfem", "ader-dgfem")
    ]
    script(
        "postprocessing/figures.py",
        *runs,
        "--out",
        tmp_path / "figures",
        "--reference",
        "tests/data/impact_bottom_0.00177.csv",
    )
    names = ["figure3_map_S1T1", "figure4_map_S2T2", "figure5_bottom_line"]
    assert sorted(p.name for p in (tmp_path / "figures").iterdir()) == [
        f"{n}.{e}" for n in names for e in ("png", "svg")
    ]


def test_any_field_is_rendered(run_factory, tmp_path):
    run = run_factory(distortion=0.2)
    for field in ("cauchy_stress", "velocity", "jacobian"):
        script(
            "postprocessing/render.py", run, "--field", field, "--points", "--edges", "--out", tmp_path / f"{field}.png"
        )
        assert (tmp_path / f"{field}.png").stat().st_size > 10_000
