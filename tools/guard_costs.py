"""Counts what guards add to a step, in instructions of a step under valgrind, and writes the table to docs/hard_cases.md.

    tools/guard_costs.py PROGRAM PAGE

A strip of the paper's impact (30 x 8 cells, S2, ADER-DGMPM, one thread). A count is the difference of two runs of different length over their
difference in steps, so that the set-up is left out.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

MESH = "mesh.rectangle={size=[3.0,0.8],cells=[30,8]}"
CELLS = 240
BASE = ['limiter={kind="off"}', "curl.control=off", "scheme.flux=rusanov", "output=[]", MESH]
LIMITED = "limiter={{kind=\"moment\",rescue={rescue},threshold={threshold}}}"
LEDGER = "output=[{kind=\"ledger\",every_steps=1}]"
# Name, what differs from the row that it is compared with, number of that row.
ROWS = [
    ("no control of the curl, flux `rusanov`, no limiter", [], None),
    ("control of the curl `rotation` (the default)", ["curl.control=rotation"], 0),
    ("control of the curl `lcf`", ["curl.control=lcf"], 0),
    ("flux `dual`, which holds the displacement", ["scheme.flux=dual"], 0),
    ("balance of energy and totals in each step (`ledger`)", [LEDGER], 0),
    ("rescue that is never needed", ["limiter={kind=\"off\",rescue=true}"], 0),
    ("sensor that marks no cell", [LIMITED.format(rescue="false", threshold="1e9")], 0),
    ("moment limiter, sensor included", [LIMITED.format(rescue="false", threshold="1.0")], 0),
    ("moment limiter and rescue (`[limiter]` as it is)", [LIMITED.format(rescue="true", threshold="1.0")], 0),
]
ENDS = [1.5e-4, 3e-4]
MARK = "## What guards cost"


def run(program, scene, sets, end, folder):
    """Instructions and steps of a run, and the share of cells that were marked."""
    out = Path(folder, "run")
    command = [program, "run", scene, "--out", out, "--force", "--threads", "1", "--set", f"time.end={end}"]
    for one in sets:
        command += ["--set", one]
    counts = Path(folder, "callgrind")
    tool = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={counts}"]
    subprocess.run(tool + [str(word) for word in command], check=True, capture_output=True)
    total = next(line for line in counts.read_text().splitlines() if line.startswith(("totals:", "summary:")))
    summary = json.loads((out / "summary.json").read_text())
    marked = summary.get("treated_cells", {}).get("marked", {}).get("mean", 0.0)
    return int(total.split()[1]), summary["steps"], marked


def main():
    program, page = sys.argv[1:]
    scene = Path(__file__).parent.parent / "meshes/hard/impact.toml"
    counts, lines = [], []
    for name, sets, against in ROWS:
        keys = {one.split("=")[0] for one in sets}
        sets = [one for one in BASE if one.split("=")[0] not in keys] + sets
        with tempfile.TemporaryDirectory() as folder:
            (a, first, _), (b, last, marked) = (run(program, scene, sets, end, folder) for end in ENDS)
        counts.append((b - a) / (last - first) / CELLS)
        more = "" if against is None else f"{100 * (counts[-1] / counts[against] - 1):+.1f} %"
        marks = f", {100 * marked:.1f} % of the cells marked" if marked else ""
        lines.append(f"| {name}{marks} | {counts[-1]:.0f} | {more} |")
        print(lines[-1], flush=True)
    text = Path(page).read_text().split(MARK)[0].rstrip()
    table = "\n".join(["| | instructions a cell and step | more |", "|---|---|---|", *lines])
    text += f"\n\n{MARK}\n\nInstructions of a step (AVX2), a strip of the paper's impact at 200 m/s, 30 x 8 cells, S2, ADER-DGMPM, from .15 to .3 ms:\n\n{table}\n"
    Path(page).write_text(text)


main()
