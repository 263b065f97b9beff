#!/usr/bin/env bash
# Shows that an effect that a scene does not ask for costs nothing: the standard scene, on 8 x 8 cells and without any effect, under the
# full program and under one that was built without effects. Compares, with callgrind, the instructions of all blocks in all steps, and
# the bits of fields and energies, which CSV files have. A build each, with the kernels that callgrind can run.
# usage: tools/proof.sh [EFFECT..]    such as forces, a program without each; by default all of them (half an hour); or `all`, one
#                                     program without any, which may take 1 % more
# Exit code 1: more than .1 % of instructions, or other bits.
set -euo pipefail
cd "$(dirname "$0")/.."

all=$(sed -n 's/^effect-\([a-z]*\) = .*/\1/p' Cargo.toml)
effects=${*:-$all}
target=$(cargo metadata --format-version 1 --no-deps --offline | python3 -c 'import json, sys; print(json.load(sys.stdin)["target_directory"])')
out=runs/proof
mkdir -p "$out"

# build NAME [EFFECT TO LEAVE OUT, or all]
build() {
    local features=
    for effect in $all; do
        [ "${2:-}" = all ] || [ "$effect" = "${2:-}" ] || features="$features,effect-$effect"
    done
    cargo build --release --quiet --no-default-features --features "${features#,}"
    cp "$target/release/dgmpm" "$out/$1"
}

# count NAME: instructions of its run, whose state is left in $out/NAME.run
count() {
    rm -rf "$out/$1.run"
    RAYON_NUM_THREADS=1 valgrind --tool=callgrind --callgrind-out-file=/dev/null --toggle-collect='*schedule*Pass*run*' \
        "$out/$1" run meshes/square_impact.toml --kernel avx2 --threads 1 --out "$out/$1.run" \
        --set 'mesh={rectangle={size=[3.0,3.0],cells=[8,8]}}' --set curl.control=off --set time.end=2e-4 \
        --set 'output=[{kind="line",name="a",from=[0,0],to=[3,3],samples=500,at=[2e-4]},{kind="ledger",balance=false,every_steps=1}]' 2>&1 >/dev/null |
        sed -n 's/.*Collected : *//p'
}

failed=0
lines=()
for effect in $effects; do build "without-$effect" "$effect"; done
build full
full=$(count full)
for effect in $effects; do
    without=$(count "without-$effect")
    percent=$(python3 -c "print(f'{100 * ($full / $without - 1):+.4f}')")
    bits=same
    for file in lines/a.csv ledger.csv; do
        cmp -s "$out/full.run/$file" "$out/without-$effect.run/$file" || bits=other
    done
    lines+=("$(printf '%-12s %14s %14s %10s %% %s bits' "$effect" "$full" "$without" "$percent" "$bits")")
    [ "$effect" = all ] && bound=1.01 || bound=1.001
    python3 -c "import sys; sys.exit(not ($full <= $bound * $without and '$bits' == 'same' and $full > 0))" || failed=1
done
printf '%-12s %14s %14s %12s\n' effect full without difference
printf '%s\n' "${lines[@]}"
exit $failed
