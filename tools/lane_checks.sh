#!/usr/bin/env bash
# AddressSanitizer and Miri on the tests of `lane`, the one module with unsafe code. It stands alone in a crate of its own, so that
# nothing else is built for them. Needs the nightly toolchain, and for Miri its components miri and rust-src.
set -euo pipefail
cd "$(dirname "$0")/.."

alone=$(mktemp -d)
trap 'rm -rf "$alone"' EXIT
mkdir "$alone/src"
cp -r core/src/lane core/src/lane.rs "$alone/src"
printf '//! The module `lane` of dgmpm alone.\npub mod lane;\n' >"$alone/src/lib.rs"
cat >"$alone/Cargo.toml" <<'TOML'
[package]
name = "lane-alone"
version = "0.0.0"
edition = "2024"

[dev-dependencies]
proptest = { version = "1.11.0", default-features = false, features = ["std"] }

[workspace]
TOML
cd "$alone"
target=$(rustc +nightly -vV | sed -n 's/^host: //p')
export CARGO_TARGET_DIR=$alone/target

echo "AddressSanitizer, all paths that this processor has:"
RUSTFLAGS=-Zsanitizer=address cargo +nightly test --lib --target "$target"
if cargo +nightly miri --version >/dev/null 2>&1; then
    # A hundred times slower: without the tests that go through 200 000 numbers.
    export PROPTEST_CASES=8 MIRIFLAGS=-Zmiri-disable-isolation
    echo "Miri, the portable path:"
    cargo +nightly miri test --lib --target "$target" -- joined picked all_paths counted dual
    if [ "${target%%-*}" = x86_64 ]; then
        echo "Miri, the path of AVX2 (it does not know all of AVX-512):"
        RUSTFLAGS="-Ctarget-feature=+avx2,+fma" cargo +nightly miri test --lib --target "$target" -- joined picked all_paths
    fi
else
    echo "skipped: Miri is not installed (rustup +nightly component add miri rust-src)"
fi
