"""Runs of the program for the cases."""

import os
import subprocess
from pathlib import Path

from dgmpm_io import Run

ROOT = Path(__file__).resolve().parents[2]


class Finished:
    """The runs of a case by label, and the CPU seconds of each."""

    def __init__(self):
        self.runs, self.seconds = {}, {}

    def add(self, program, case, label, folder):
        """Runs the scene of a case with what a label sets, on one thread."""
        out = folder / "_".join([case.name, *"".join(c if c.isalnum() else " " for c in label).split()])
        command = [program, "run", ROOT / "meshes" / case.scene, "--out", out, "--force", "--quiet", "--threads", "1"]
        for pair in case.runs[label]:
            command += ["--set", pair]
        before = os.times()
        done = subprocess.run(command, capture_output=True, text=True)
        after = os.times()
        if done.returncode:
            raise SystemExit(f"{case.name} {label}: exit code {done.returncode}\n{done.stderr}")
        self.runs[label] = Run(out)
        self.seconds[label] = (
            after.children_user + after.children_system - before.children_user - before.children_system
        )

    def numbers(self, case):
        """The lines of a case whose runs are there, each with our number."""
        lines = (line for line in case.lines if set(line.runs) <= set(self.runs))
        return [(line, float(line.measure(self.runs))) for line in lines]


def program():
    """The program, by tools/program.sh, which says what is wrong where there is none."""
    answer = subprocess.run([ROOT / "tools/program.sh"], stdout=subprocess.PIPE, text=True)
    if answer.returncode:
        raise SystemExit(answer.returncode)
    return answer.stdout.strip()
