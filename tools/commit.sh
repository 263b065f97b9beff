#!/usr/bin/env bash
# Prints the commit of the checkout, with "-changed" where files differ from it; "unknown" outside of git. `make build` hands it to the
# program, which writes it into each file of results.
# usage: DGMPM_COMMIT=$(tools/commit.sh) cargo build --release
set -euo pipefail
cd "$(dirname "$0")/.."

if ! commit=$(git rev-parse --verify --quiet HEAD 2>/dev/null); then
    echo unknown
elif git diff --quiet HEAD 2>/dev/null; then
    echo "$commit"
else
    echo "$commit-changed"
fi
