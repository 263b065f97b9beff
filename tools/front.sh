#!/usr/bin/env bash
# The impact on a grid that follows its front, against uniform 60 x 60 cells: differences at 3e-4 s, and CPU times.
# Further arguments go to both runs, for instance: tools/front.sh --set material.0.law=j2 ...
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
python=${DGMPM_PYTHON:-.venv/bin/python}
out=${OUT:-runs}
scene=meshes/square_front.toml

"$dgmpm" run "$scene" --out "$out/square_front" --force --threads 1 "$@"
"$dgmpm" run "$scene" --out "$out/square_uniform" --force --threads 1 "$@" \
    --set "regrid=[]" --set "mesh.rectangle.cells=[60,60]"
for run in square_front square_uniform; do
    "$dgmpm" export "$out/$run" --format vtu
done
"$python" postprocessing/front.py "$out/square_front" "$out/square_uniform" --time 3e-4
