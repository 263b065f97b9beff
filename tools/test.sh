#!/usr/bin/env bash
# All tests: Rust (unit, integration, documentation), then Python. DOLFINx is used where it is or may be installed.
set -euo pipefail
cd "$(dirname "$0")/.."

# DOLFINx belongs to Debian's own python3; it finds no packages of .venv and needs none.
dolfinx_python=/usr/bin/python3
has_dolfinx() { "$dolfinx_python" -c 'import dolfinx, h5py' 2>/dev/null; }
install_python() {
    tools/setup.sh python
    has_dolfinx || tools/apt.sh python3-dolfinx-real python3-h5py || true
}

# What only tests need is installed while cargo builds, which takes longer.
tools/setup.sh packages
install_python &
# Examples are compiled by clippy, in CI and for who changes them.
tests=(--release --lib --bins --tests)
cargo test "${tests[@]}" --no-run
wait $!
if has_dolfinx; then
    export DGMPM_DOLFINX_PYTHON=$dolfinx_python
else
    echo "skipped: the comparisons with DOLFINx (python3-dolfinx-real or python3-h5py is not there and could not be installed)"
fi

export DGMPM_PYTHON=$PWD/.venv/bin/python DGMPM_REQUIRE_PYTHON=1
# Beside the tests in Rust, which leave a seventh of two processors idle.
log=$(mktemp)
trap 'rm -f "$log"' EXIT
"$DGMPM_PYTHON" -m pytest -q tests/python >"$log" 2>&1 &
rust=0
cargo test "${tests[@]}" || rust=$?
python=0
wait $! || python=$?
cat "$log"
[ "$rust" = 0 ] && [ "$python" = 0 ] || exit 1
cargo test --release --doc
tools/ranks.sh
