#!/usr/bin/env bash
# Opens all kinds of exported files in the real ParaView, without a window, and draws figure 3 of the paper with it: docs/img/paraview.png.
# Installs Debian's paraview (1 GB) where it is missing and may be installed.
set -euo pipefail
cd "$(dirname "$0")/.."

command -v pvbatch >/dev/null && command -v xvfb-run >/dev/null || tools/apt.sh paraview python3-paraview xvfb xauth
dgmpm=$(tools/program.sh)
runs=()
for method in rk-dgfem ader-dgfem ader-dgmpm; do
    run=runs/paraview/$method
    "$dgmpm" run meshes/square_impact.toml --out "$run" --force --set "scheme.method=$method" \
        --set scheme.degree=1 --set scheme.time_degree=1
    "$dgmpm" export "$run" --format vtu,xdmf,vtkhdf
    "$dgmpm" export "$run" --format vtu,xdmf,vtkhdf --deformed
    runs+=("$run")
done
# Debian's ParaView needs an X server, and opens it twice: one that resets in between refuses the second time.
xvfb-run -a -s "-noreset -screen 0 1920x1200x24" \
    pvbatch postprocessing/paraview_check.py "${runs[@]}" --out docs/img/paraview.png
