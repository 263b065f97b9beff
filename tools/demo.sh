#!/usr/bin/env bash
# The paper's impact by all three methods at S1T1 and S2T2, exported for ParaView, and its figures 3 to 5.
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
scene=meshes/square_impact.toml
start=$SECONDS

# The scene as it stands (ADER-DGMPM, S2T2), then its variants.
"$dgmpm" run "$scene" --out runs/square_impact --force
runs=(runs/square_impact)
for degree in 1 2; do
    for method in rk-dgfem ader-dgfem ader-dgmpm; do
        [ "$method-$degree" != ader-dgmpm-2 ] || continue
        run=runs/square_impact-$method-s$degree
        "$dgmpm" run "$scene" --out "$run" --force --set "scheme.method=$method" \
            --set "scheme.degree=$degree" --set "scheme.time_degree=$degree"
        runs+=("$run")
    done
done
for run in "${runs[@]}"; do
    "$dgmpm" export "$run"
done

.venv/bin/python postprocessing/figures.py "${runs[@]}" --reference tests/data/impact_bottom_0.00177.csv --out runs/figures
.venv/bin/python postprocessing/render.py runs/square_impact --points --out runs/figures/square_impact.png

echo
echo "done in $((SECONDS - start)) s"
echo "  figures             runs/figures/ (the paper's figures 3, 4 and 5, and a picture of the last step)"
echo "  for ParaView        runs/square_impact/export/grid.pvd and points.pvd"
echo "  numbers of the run  runs/square_impact/summary.json"
