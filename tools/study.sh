#!/usr/bin/env bash
# What accuracy costs in time, anew: three methods, S1 to S4, on the simple wave, the smooth box and the impact of a bar,
# whose shock is known exactly. (For the paper's square no run on this kind of machine is a reference: at a shock the
# error of a finer run is as large as what it is to measure. `dgmpm study` says so where it is tried.)
# Tables go into docs/cost.md between its markers, plots into docs/img.
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
start=$SECONDS
"$dgmpm" study meshes/simple_wave.toml --refine 0.5,1,2 --out runs/study/simple_wave --force
"$dgmpm" study meshes/smooth_box.toml --refine 0.25,0.5,1,1.5 --out runs/study/smooth_box --force
"$dgmpm" study meshes/wall_impact.toml --refine 0.5,1,2 --out runs/study/wall_impact --force
.venv/bin/python tools/study_tables.py runs/study
echo "done in $((SECONDS - start)) s"
