//! The step takes no more instructions than it did: a guard that does not depend on the clock. `valgrind
//! --tool=callgrind` counts a short and a longer run of the same wave; their difference is the steps alone.
//!
//! The stored figures are those of the AVX2 path (valgrind has no AVX-512). After a change that is meant:
//! `DGMPM_UPDATE=1 cargo test --release --test instructions` writes them anew.
#![cfg(target_arch = "x86_64")]

use std::fmt::Write;
use std::path::Path;
use std::process::Command;

/// Steps of the short run, and how many more the longer one has.
const SHORT: usize = 1;
const MORE: usize = 64;
/// Growth that fails. The counts of one program repeat to 1 % (what differs: seeds of hash tables, at the start and the
/// end of a run, do not cancel); another compiler may move them by some per cent.
const GROWTH: f64 = 1.05;

/// Name in `tests/data/instructions.toml` and arguments; 8 x 8 cells are whole blocks.
const CASES: [(&str, &[&str]); 3] = [
    ("rk-dgfem-s2", &["--method", "rk-dgfem"]),
    ("ader-dgmpm-s2-lattice", &["--method", "ader-dgmpm", "--layout", "midpoints"]),
    ("ader-dgmpm-s2-jitter", &["--method", "ader-dgmpm", "--layout", "jitter"]),
];

fn stored() -> std::path::PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/instructions.toml")
}

/// Instructions of a run of so many steps.
fn instructions(folder: &Path, arguments: &[&str], steps: usize) -> u64 {
    let run = Command::new("valgrind")
        .arg("--tool=callgrind")
        .arg(format!("--callgrind-out-file={}", folder.join("out").display()))
        .arg(env!("CARGO_BIN_EXE_dgmpm"))
        .args(["bench", "--degree", "2", "--cells", "8,8", "--kernel", "avx2", "--threads", "1", "--oneline"])
        .args(arguments)
        .args(["--steps", &steps.to_string()])
        // Matrices are built on rayon's common threads, which spin before they sleep: one makes the count repeat.
        .env("RAYON_NUM_THREADS", "1")
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&run.stderr).into_owned();
    assert!(run.status.success(), "{text}");
    let total =
        text.lines().find_map(|line| line.split_once("Collected :").map(|(_, number)| number.trim().to_owned()));
    total.and_then(|number| number.parse().ok()).unwrap_or_else(|| panic!("no count in {text}"))
}

/// Instructions of one cell in one step.
fn per_cell_step(folder: &Path, arguments: &[&str]) -> f64 {
    let [short, long] = [SHORT, SHORT + MORE].map(|steps| instructions(folder, arguments, steps));
    (long - short) as f64 / (MORE * 64) as f64
}

fn has_avx2() -> bool {
    is_x86_feature_detected!("avx2") && is_x86_feature_detected!("fma")
}

#[test]
fn a_step_takes_no_more_instructions_than_the_stored_figure_and_5_per_cent() {
    if cfg!(debug_assertions) || !has_avx2() {
        println!("skipped: the figures are those of the optimised program on AVX2");
        return;
    }
    if Command::new("valgrind").arg("--version").output().is_err() {
        println!("skipped: valgrind is not installed (make setup does it)");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let found = CASES.map(|(name, arguments)| (name, per_cell_step(folder.path(), arguments)));
    if std::env::var_os("DGMPM_UPDATE").is_some() {
        let mut text =
            "# Instructions of one cell in one step on AVX2, by callgrind; see tests/instructions.rs.\n".to_owned();
        found.iter().for_each(|(name, count)| writeln!(text, "{name} = {count:.0}").unwrap());
        return std::fs::write(stored(), text).unwrap();
    }
    let table: toml_edit::DocumentMut = std::fs::read_to_string(stored()).unwrap().parse().unwrap();
    let mut grown = Vec::new();
    for (name, count) in found {
        let stored = table[name].as_integer().unwrap() as f64;
        let ratio = count / stored;
        println!("{name}: {count:.0} instructions a cell and step, stored {stored}: {:+.1} %", 100.0 * (ratio - 1.0));
        if ratio > GROWTH {
            grown.push(format!("{name}: {count:.0} instructions a cell and step, {ratio:.3} of the stored {stored}"));
        }
        if ratio < 2.0 - GROWTH {
            println!("{name} got cheaper: store it, so that it stays so (see below)");
        }
    }
    let remedy = "if it is meant: DGMPM_UPDATE=1 cargo test --release --test instructions";
    assert!(grown.is_empty(), "{}\n{remedy}", grown.join("\n"));
}
