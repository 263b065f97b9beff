#!/usr/bin/env bash
# What accuracy costs in time, anew. Smooth part: three methods, S1 to S4, on the simple wave, the smooth box and the impact of
# a bar, whose shock is known exactly. Hard part: quantities of interest of the paper's impact with the limiter, of a Taylor bar
# and of a plate with a hole, whose errors are extrapolated (for them no run on this kind of machine is a reference: at a shock
# the error of a finer run is as large as what it is to measure).
# Tables go into docs/cost.md between its markers, plots into docs/img. `tools/study.sh hard` makes that part alone.
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
start=$SECONDS
parts=("$@")
[[ $# -gt 0 ]] || parts=(smooth hard)

study() {
    "$dgmpm" study "$1" --out "runs/study/$2" --force "${@:3}"
}

for part in "${parts[@]}"; do
    case $part in
    smooth)
        study meshes/simple_wave.toml simple_wave --refine 0.5,1,2
        study meshes/smooth_box.toml smooth_box --refine 0.25,0.5,1,1.5
        study meshes/wall_impact.toml wall_impact --refine 0.5,1,2
        ;;
    hard)
        study meshes/hard/impact.toml hard_impact --degrees 1,2 --refine 1,2,3 --measure kinetic_energy
        study meshes/hard/taylor_copper.toml hard_taylor --degrees 1,2 --refine 0.5,1,1.5 --measure final_length --set limiter.kind=off
        study meshes/hard/taylor_copper.toml hard_taylor_limited --methods ader-dgmpm --degrees 1,2 --refine 0.5,1,1.5 --measure final_length
        study meshes/hard/plate_hole.toml hard_plate --methods ader-dgmpm --degrees 1,2 --refine 1,2,3 --measure wall_force
        ;;
    *)
        echo "there is no part $part: give smooth, hard, or nothing for both" >&2
        exit 2
        ;;
    esac
    .venv/bin/python tools/study_tables.py runs/study "$part"
done
echo "done in $((SECONDS - start)) s"
