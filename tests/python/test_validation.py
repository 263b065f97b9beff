"""The gallery of validation itself: its list, its measures, its solutions."""

import dataclasses
import sys

import numpy as np
import pytest
from conftest import ROOT

sys.path[:0] = [str(ROOT / "tools"), str(ROOT / "tools" / "validation")]

import measures
import page
import solutions
from cases import CASES

LINES = [line for case in CASES for line in case.lines]


def test_each_case_has_its_scene_runs_picture_and_reasons():
    assert len({case.name for case in CASES}) == len({case.title for case in CASES}) == len(CASES)
    written = (ROOT / "docs/validation.md").read_text()
    for case in CASES:
        assert (ROOT / "meshes" / case.scene).is_file() and case.text.endswith(".")
        assert {case.picture.run, *case.quick, *(run for line in case.lines for run in line.runs)} <= set(case.runs)
        assert f"\n## {case.title}\n" in written and (ROOT / f"docs/validation/{case.name}.png").is_file()
        assert all(line.reason and line.allowed > 0 and np.isfinite(line.reference) for line in case.lines)
        # A line that `make test` holds is not one that nobody holds.
        assert not any(line.open for line in case.lines if set(line.runs) <= set(case.quick))


@pytest.mark.parametrize("line", LINES, ids=lambda line: line.quantity)
def test_a_line_holds_its_reference_and_refuses_what_is_beyond_its_bound_or_no_number(line):
    far = 1.01 * line.allowed * (1 if line.absolute else abs(line.reference))
    assert page.within(line, line.reference)
    assert not any(page.within(line, value) for value in (line.reference + far, line.reference - far, float("nan")))
    assert not page.within(dataclasses.replace(line, allowed=line.allowed / 2), line.reference + 0.6 * far)


def test_measures_find_what_is_put_in():
    t = np.linspace(0, 1, 2001)
    assert measures.frequency(t, 3 * np.sin(21 * t + 1) + 0.5 * t - 2, 20.0) == pytest.approx(21, rel=1e-6)
    time, value = measures.turn(t, (t - 0.31234) ** 2 - 4, 624)
    assert (time, value) == (pytest.approx(0.31234, abs=1e-9), pytest.approx(-4))
    begin, end = measures.contact(t, np.clip(np.minimum(t - 0.2, 0.7 - t) * 100, 0, 5))
    assert (begin, end) == (pytest.approx(0.225), pytest.approx(0.675))
    assert measures.order(8e-3, 1e-3) == pytest.approx(3)
    assert measures.rise(np.array([2.0, 1.0, 2.2])) == pytest.approx(0.1)


def test_the_intensity_of_an_exact_opening_is_found():
    # The opening of a tip with K, with the next term of the series.
    r, k = np.linspace(0.01, 1, 100), 1e9
    opening = 8 * (1 - 0.3**2) / 2.1e11 * k * np.sqrt(r / (2 * np.pi)) * (1 + 0.2 * r)
    assert solutions.opening_intensity(r, opening, (0.2, 0.8)) == pytest.approx(k, rel=1e-6)
    assert solutions.freund(1.009339e-3) == pytest.approx(1.0195e9, rel=1e-4)


def test_lambs_waves_come_when_they_can_and_rayleighs_is_the_largest():
    t = np.linspace(0, 0.8, 1601)
    for component in (1, 2):
        u = solutions.lamb(1000.0, component, t)
        # The force is over 1e-4 of its peak from .026 s on; the width of 40 m lets the pressure wave start 100 m nearer.
        assert np.abs(u[t < 0.026 + 900 / 3200]).max() < 1e-4 * np.abs(u).max()
        # c_R = .9194 c_S for this Poisson's ratio of .25; the wave is two lobes of .02 s wide.
        assert t[np.abs(u).argmax()] == pytest.approx(0.08 + 1000 / (0.9194 * 1847.5), abs=0.02)
    # The surface goes down under a force downwards.
    assert solutions.lamb(0.0, 2, t)[t < 0.08].min() < 0
