#!/usr/bin/env bash
# All tests: Rust (unit, integration, documentation), then Python. DOLFINx is used where it is or may be installed.
set -euo pipefail
cd "$(dirname "$0")/.."

# DOLFINx belongs to Debian's own python3; it finds no packages of .venv and needs none.
dolfinx_python=/usr/bin/python3
has_dolfinx() { "$dolfinx_python" -c 'import dolfinx, h5py' 2>/dev/null; }
# It is installed while cargo builds, which takes longer.
has_dolfinx || tools/apt.sh python3-dolfinx-real python3-h5py &
# Examples are compiled by clippy, in CI and for who changes them.
tests=(--release --lib --bins --tests)
cargo test "${tests[@]}" --no-run
wait
if has_dolfinx; then
    export DGMPM_DOLFINX_PYTHON=$dolfinx_python
else
    echo "skipped: the comparisons with DOLFINx (python3-dolfinx-real or python3-h5py is not there and could not be installed)"
fi

export DGMPM_PYTHON=$PWD/.venv/bin/python DGMPM_REQUIRE_PYTHON=1
cargo test "${tests[@]}"
cargo test --release --doc
tools/ranks.sh
"$DGMPM_PYTHON" -m pytest -q tests/python
