#!/usr/bin/env bash
# The archives of `cargo package` build from themselves alone: they are unpacked away from the checkout and checked there. The
# compiled dependencies of the checkout are used again, so that this costs the check of two crates.
set -euo pipefail
cd "$(dirname "$0")/.."

metadata=$(cargo metadata --format-version 1 --no-deps --offline)
read_places='import json, sys; m = json.load(sys.stdin); print(m["target_directory"], next(p["version"] for p in m["packages"] if p["name"] == "dgmpm"), sep="\n")'
{ read -r target; read -r version; } < <("${PYTHON:-python3}" -c "$read_places" <<<"$metadata")

# One warning a test file says that the archive lacks it, as is meant.
cargo package -p dgmpm-core -p dgmpm --no-verify --allow-dirty --offline 2>&1 | grep -v '^warning: ignoring test ' >&2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for crate in dgmpm-core dgmpm; do
    archive=$target/package/$crate-$version.crate
    size=$(stat -c %s "$archive")
    [ "$size" -le 1000000 ] || { echo "$archive: $size bytes, more than 1 MB: see \`include\` in Cargo.toml" >&2; exit 1; }
    # `-m`: the files count as new. With the times of the archive cargo would take an earlier check for theirs.
    tar -xzmf "$archive" -C "$folder"
done

# The same place of hdf5.pc as in the checkout: another one would compile everything above HDF5 again.
export PKG_CONFIG_PATH=$PWD/tools/pkgconfig${PKG_CONFIG_PATH:+:$PKG_CONFIG_PATH}
cd "$folder/dgmpm-$version"
# What the registry would give once both are there: the archive beside this one.
cargo check --release --offline --target-dir "$target" --config "patch.crates-io.dgmpm-core.path='$folder/dgmpm-core-$version'"
