#!/usr/bin/env bash
# Prints the path of the program: that of `DGMPM` where it is set, else that of the release build, wherever cargo puts it
# (CARGO_TARGET_DIR, or `build.target-dir` in a configuration of cargo).
# usage: dgmpm=$(tools/program.sh)
# Exit code 1: there is no such program; the message says how to make it.
set -euo pipefail

if [ -n "${DGMPM:-}" ]; then
    echo "$DGMPM"
    exit 0
fi
cd "$(dirname "$0")/.."

metadata=$(cargo metadata --format-version 1 --no-deps --offline)
read_target='import json, sys; print(json.load(sys.stdin)["target_directory"])'
target=$("${PYTHON:-python3}" -c "$read_target" <<<"$metadata")

# Where a target triple is named (CARGO_BUILD_TARGET, `build.target`) cargo adds a folder of that name: the newest build counts.
newest=
for program in "$target"/release/dgmpm "$target"/*/release/dgmpm; do
    if [ -x "$program" ] && { [ -z "$newest" ] || [ "$program" -nt "$newest" ]; }; then
        newest=$program
    fi
done
if [ -z "$newest" ]; then
    echo "no program at $target/release/dgmpm: 'make build' makes it; the variable DGMPM can name another one" >&2
    exit 1
fi
echo "$newest"
