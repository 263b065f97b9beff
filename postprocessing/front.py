"""How far a run of the impact is from another, by averages over blocks of 0.1 m, and what both cost.

usage: front.py RUN REFERENCE_RUN [--time 3e-4]      (both exported)

Prints relative L1 = sum|a - b| / sum|b| of sigma11 and v1, and the CPU seconds of both runs.
"""

import argparse
import json
import sys
from pathlib import Path

import exported

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "tests" / "reference"))
import compare  # noqa: E402


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("run", type=Path)
    parser.add_argument("reference", type=Path)
    parser.add_argument("--time", type=float, default=3e-4)
    arguments = parser.parse_args()
    runs = (arguments.run, arguments.reference)
    paths = [exported.step_at(run, arguments.time)[1] for run in runs]
    blocks = [compare.block_averages(exported.read_grid(path)) for path in paths]
    for name in ("s11", "v1"):
        a, b = (part[name] for part in blocks)
        print(f"{name}: relative L1 {abs(a - b).sum() / abs(b).sum():.3%}")
    seconds = [json.loads((run / "summary.json").read_text())["cpu_seconds"] for run in runs]
    print(f"CPU: {seconds[0]:.2f} s against {seconds[1]:.2f} s, {seconds[0] / seconds[1]:.1%}")


if __name__ == "__main__":
    main()
