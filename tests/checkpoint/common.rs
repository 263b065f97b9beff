//! Scenes, folders and what a run has written.

use crate::bodies::Parts;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A small impact of S2T2 that changes its grid, with plasticity and outputs: some 60 steps. `make faults` has it too.
pub const SCENE: &str = include_str!("case.toml");

/// A folder of its own, with the scene `case.toml`.
pub struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// Writes `parts.toml`, a scene of a mesh of parts: the pairs of group and condition, and the velocity.
    pub fn of_parts(&self, parts: &Parts, conditions: &[(&str, &str)], velocity: &str) {
        parts.write(&self.path("."));
        let conditions: String =
            conditions.iter().map(|(group, kind)| format!("{{group=\"{group}\",{kind}}},")).collect();
        let text = format!(
            "title = \"parts\"\nmesh.file = \"mesh.msh\"\nboundary = [{conditions}]\n[[material]]\nlaw = \"neo-hookean\"\nyoung = 2e11\npoisson = 0.3\n\
             density = 7800\n[initial]\nvelocity = [{velocity}]\n[scheme]\nmethod = \"ader-dgmpm\"\ndegree = 2\n[time]\nend = 2e-4\n\
             [[output]]\nkind = \"ledger\"\n[[output]]\nkind = \"fields\"\nevery = 5e-5\n[[output]]\nkind = \"force\"\nname = \"f\"\n"
        );
        std::fs::write(self.path("parts.toml"), text).unwrap();
    }

    /// Writes `mixed.toml`, a scene of a body in a hundred blocks. Those of its left half flow, those of its right half have 25 points a cell
    /// and matrices of their own.
    pub fn of_mixed_body(&self) {
        Parts::default().halves([2.0, 1.0], [20, 40], ["left", "right"], "out").write(&self.path("."));
        let steel = "young = 2e11, poisson = 0.3, density = 7800";
        let text = format!(
            "title = \"mixed\"\nmesh.file = \"mesh.msh\"\nboundary = [{{ group = \"out\", kind = \"free\" }}]\nmaterial = [\n\
             {{ group = \"left\", law = \"j2\", {steel}, yield_stress = 4e8, hardening = 1e9 }},\n\
             {{ group = \"right\", law = \"neo-hookean\", {steel}, layout = \"jitter\", per_direction = 5 }}]\n\
             [initial]\nvelocity = [\"-200*step(x - 0.9)\", \"20*x*y\"]\n[scheme]\nmethod = \"ader-dgmpm\"\ndegree = 2\n\
             [time]\nend = 7e-6\n[[output]]\nkind = \"ledger\"\n[[output]]\nkind = \"fields\"\nevery = 3.5e-6\n"
        );
        std::fs::write(self.path("mixed.toml"), text).unwrap();
    }

    /// Writes `parts.toml`, a scene of two bodies that meet and slide.
    pub fn of_two_bodies(&self) {
        let mut parts = Parts::default();
        let sides = |sides: [&str; 4]| sides.map(str::to_owned);
        parts.rectangle([0.0; 2], [1.0, 0.5], [6, 3], "body", &sides(["out", "a", "out", "out"]));
        parts.rectangle([1.005, 0.1], [0.5, 0.5], [3, 3], "body", &sides(["b", "out", "out", "out"]));
        let conditions = [("out", "kind=\"free\""), ("a", "kind=\"contact\",partner=\"b\",friction=0.3")];
        self.of_parts(&parts, &conditions, "\"100*step(1.001 - x)\", \"-30*step(x - 1.001)\"");
    }

    pub fn new() -> Self {
        let bench = Self { folder: tempfile::tempdir().unwrap() };
        std::fs::write(bench.path("case.toml"), SCENE).unwrap();
        bench
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_dgmpm"));
        command.args(arguments.split_whitespace()).current_dir(self.folder.path());
        command
    }

    pub fn output(&self, arguments: &str) -> Output {
        self.command(arguments).output().unwrap()
    }

    /// Runs a command that has to end with code 0; what it says.
    pub fn run(&self, arguments: &str) -> String {
        let output = self.output(arguments);
        let errors = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(0), "{arguments}: {errors}");
        String::from_utf8_lossy(&output.stdout).into_owned() + &errors
    }

    /// Runs a command that has to end with this code; its message.
    pub fn fail(&self, code: i32, arguments: &str) -> String {
        let output = self.output(arguments);
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(code), "{arguments}: {errors}");
        let messages = errors.lines().filter(|line| line.starts_with("error: ")).count();
        assert_eq!(messages, 1, "one message: {errors}");
        errors
    }
}

/// What a run has written, by file: the numbers that do not depend on clocks. Checkpoints and matrices are no results.
pub fn results(root: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut out = BTreeMap::new();
    let mut folders = vec![root.to_owned()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.strip_prefix(root).unwrap().to_str().unwrap().to_owned();
            let bytes = || std::fs::read(&path).unwrap();
            match &name[..] {
                "checkpoints" | "operators.h5" | ".dgmpm" => {}
                _ if path.is_dir() => folders.push(path),
                "summary.json" => drop(out.insert(name, without_clocks(&bytes()))),
                "regrid.csv" => drop(out.insert(name, first_columns(&bytes(), 12))),
                _ => drop(out.insert(name, bytes())),
            }
        }
    }
    out
}

/// Without seconds, memory, threads, and the ends that a run had on its way to the last.
fn without_clocks(text: &[u8]) -> Vec<u8> {
    let all: serde_json::Value = serde_json::from_slice(text).unwrap();
    let clock = |key: &str| {
        ["second", "phases", "memory", "threads", "effects", "bytes", "ends"].iter().any(|word| key.contains(word))
    };
    let kept = all.as_object().unwrap().iter().filter(|(key, _)| !clock(key));
    kept.map(|(key, value)| format!("{key}: {value}\n")).collect::<String>().into_bytes()
}

/// The first columns of a table; behind them `regrid.csv` has seconds.
fn first_columns(text: &[u8], count: usize) -> Vec<u8> {
    let line = |line: &str| line.split(',').take(count).collect::<Vec<_>>().join(",") + "\n";
    String::from_utf8_lossy(text).lines().map(line).collect::<String>().into_bytes()
}

/// Whether two runs have the same results, to the byte.
pub fn assert_same(name: &str, one: &Path, two: &Path) {
    let (one, two) = (results(one), results(two));
    assert_eq!(one.keys().collect::<Vec<_>>(), two.keys().collect::<Vec<_>>(), "{name}: other files");
    let differs: Vec<&String> =
        one.iter().filter(|(file, bytes)| two[*file] != **bytes).map(|(file, _)| file).collect();
    let texts =
        |all: &BTreeMap<String, Vec<u8>>| differs.first().map(|f| String::from_utf8_lossy(&all[*f]).into_owned());
    assert!(differs.is_empty(), "{name}: {differs:?} differ\n{:?}\n{:?}", texts(&one), texts(&two));
}

/// Changes a bit of a file.
pub fn flip(path: &Path, share: f64) {
    let mut bytes = std::fs::read(path).unwrap();
    let at = ((bytes.len() - 1) as f64 * share) as usize;
    bytes[at] ^= 0x10;
    std::fs::write(path, bytes).unwrap();
}

/// Copies a folder with what is below it.
pub fn copy(from: &Path, to: &Path) {
    std::fs::create_dir_all(to).unwrap();
    for entry in std::fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        if path.is_dir() { copy(&path, &target) } else { assert!(std::fs::copy(&path, &target).is_ok()) }
    }
}
