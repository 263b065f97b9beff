#!/usr/bin/env bash
# What accuracy costs in time, anew: three methods, S1 to S4, on the simple wave, the smooth box, the
# impact of a bar (exact shock) and the paper's impact of a square.
# Tables go into README.md and docs/cost.md between their markers, plots into docs/img.
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=${DGMPM:-target/release/dgmpm}
start=$SECONDS
"$dgmpm" study meshes/simple_wave.toml --refine 0.5,1,2 --out runs/study/simple_wave --force
"$dgmpm" study meshes/smooth_box.toml --refine 0.25,0.5,1,1.5 --out runs/study/smooth_box --force
"$dgmpm" study meshes/wall_impact.toml --refine 0.5,1,2 --out runs/study/wall_impact --force
# Until the shock has crossed a third of the square. At a shock no method converges faster than h^(1/2) in this measure,
# so a reference of moderate degree on a fine mesh is the better one.
"$dgmpm" study meshes/square_impact.toml --set 'mesh.rectangle={size=[3.0,3.0],cells=[30,30]}' --set 'cloud.layout=midpoints' \
    --set time.end=1.5e-4 --set 'output=[]' --refine 0.5,1,2 --reference 2,6 --out runs/study/square_impact --force
.venv/bin/python tools/study_tables.py runs/study
echo "done in $((SECONDS - start)) s"
