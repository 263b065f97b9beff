#!/usr/bin/env bash
# What each effect costs the standard scene, measured again: src/effects/measured.csv, and docs/effects.md from it. Some minutes; a quiet
# machine gives figures that mean something below 1 %.
set -euo pipefail
cd "$(dirname "$0")/.."

dgmpm=$(tools/program.sh)
commit=$(git rev-parse --short HEAD 2>/dev/null || echo unknown)
"$dgmpm" effects --measure meshes/square_impact.toml --commit "$commit" --out src/effects/measured.csv
DGMPM_UPDATE=1 cargo test --release --test effects_page
