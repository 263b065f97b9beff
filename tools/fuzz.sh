#!/usr/bin/env bash
# Runs each target of fuzz/ for some seconds (300 by default), from and into fuzz/corpus; what is found is in fuzz/artifacts. It does not
# need cargo-fuzz nor a nightly toolchain: `tools/fuzz.sh [SECONDS [TARGET..]]`.
set -euo pipefail
cd "$(dirname "$0")/../fuzz"

seconds=${1:-300}
shift || true
[ $# -gt 0 ] || set -- gmsh grids mesh scene expression cloud store

host=$(rustc -vV | sed -n 's/^host: //p')
target=${CARGO_TARGET_DIR:-$PWD/target}
# As cargo-fuzz has them, without a sanitizer: the code is safe Rust, and a panic, a wait or a large allocation is what is looked for.
export RUSTFLAGS="-Cpasses=sancov-module -Cllvm-args=-sanitizer-coverage-level=4 \
-Cllvm-args=-sanitizer-coverage-inline-8bit-counters -Cllvm-args=-sanitizer-coverage-pc-table \
-Cllvm-args=-sanitizer-coverage-trace-compares --cfg fuzzing -Cdebug-assertions"
# With --target, build scripts are built without these flags.
cargo build --release --target "$host"

mkdir -p artifacts
for name in "$@"; do
    mkdir -p "corpus/$name"
    echo "$name: $seconds s"
    "$target/$host/release/$name" "corpus/$name" -max_total_time="$seconds" -timeout=5 -rss_limit_mb=1024 -malloc_limit_mb=512 \
        -max_len=8192 -artifact_prefix="artifacts/$name-" -print_final_stats=1
done
