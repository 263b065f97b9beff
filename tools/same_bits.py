#!/usr/bin/env python3
"""Compare two builds of dgmpm: the same scenes, every snapshot equal to the last bit.

usage: same_bits.py OLD NEW [--kernel NAME] [--renamed]     two programs; exit code 1 where a number differs

A change of structure must not change a number. The runs are those of a short list: the paper's impact by three methods,
a jittered cloud, plastic flow, a regrid in mid-run, two threads.
"""

import argparse
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import h5py

ROOT = Path(__file__).resolve().parent.parent
SHORT = ["time.end=2e-4"]
# Name, scene, overrides, threads.
CASES = [
    ("impact, ADER-DGMPM", "square_impact", SHORT, 1),
    ("impact, ADER-DGFEM", "square_impact", [*SHORT, "scheme.method=ader-dgfem"], 1),
    ("impact, RK-DGFEM", "square_impact", [*SHORT, "scheme.method=rk-dgfem"], 1),
    ("impact, S3", "square_impact", [*SHORT, "scheme.degree=3", "scheme.time_degree=3", "scheme.cfl=0.3"], 1),
    ("impact, rusanov", "square_impact", [*SHORT, "scheme.flux=rusanov"], 1),
    ("jittered cloud", "square_impact", [*SHORT, "cloud.layout=jitter"], 1),
    ("unstructured", "square_unstructured", SHORT, 1),
    ("bar of two materials", "bar", [], 1),
    ("plastic bar", "bar_plastic", ["time.end=2e-4"], 1),
    ("plastic bar, RK", "bar_plastic", ["time.end=2e-4", "scheme.method=rk-dgfem"], 1),
    ("regrid", "plate_hole_regrid", [], 1),
    ("spinning square", "spinning_square", ["time.end=2e-3"], 1),
    ("impact, two threads", "square_impact", SHORT, 2),
]

# Overrides that a program needs which is from before a change of names.
RENAMED = {"bar_plastic": ["exact.kind=plastic-impact"]}


def run(program, scene, sets, threads, kernel, out):
    """Runs a scene into a folder; the run may end unstable, but it must begin."""
    command = [program, "run", str(ROOT / "meshes" / f"{scene}.toml"), "--out", str(out), "--threads", str(threads)]
    command += ["--kernel", kernel] if kernel else []
    for pair in sets:
        command += ["--set", pair]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, "HDF5_USE_FILE_LOCKING": "FALSE"})
    if done.returncode not in (0, 3):
        sys.exit(f"{' '.join(command)}\n{done.stderr}")


def numbers(file):
    """All data sets of a snapshot, as bytes."""
    found = {}
    with h5py.File(file) as store:
        store.visititems(lambda name, item: found.update({name: item[()].tobytes()}) if hasattr(item, "shape") else None)
    return found


def compare(old, new):
    """What differs between two run folders."""
    files = [sorted(p.relative_to(folder) for p in folder.glob("snapshots/*.h5")) for folder in (old, new)]
    if files[0] != files[1]:
        return [f"snapshots {[len(f) for f in files]}"]
    wrong = []
    for name in files[0]:
        a, b = numbers(old / name), numbers(new / name)
        wrong += [f"{name}: {key}" for key in sorted(a.keys() | b.keys()) if a.get(key) != b.get(key)]
    return wrong if files[0] else ["no snapshot"]


def main():
    """Runs all cases by both programs."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("old")
    parser.add_argument("new")
    parser.add_argument("--kernel")
    parser.add_argument("--renamed", action="store_true", help="OLD is from before the last change of names in scenes")
    args = parser.parse_args()
    failed = False
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, scene, sets, threads) in enumerate(CASES):
            folders = [Path(folder) / f"{number}-{which}" for which in ("old", "new")]
            renamed = RENAMED.get(scene, []) if args.renamed else []
            for program, out, more in zip((args.old, args.new), folders, (renamed, []), strict=True):
                run(program, scene, [*sets, *more], threads, args.kernel, out)
            wrong = compare(*folders)
            failed |= bool(wrong)
            print(f"{name:24} {'same' if not wrong else 'differs: ' + ', '.join(wrong[:3])}", flush=True)
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
