//! A folder with a scene, and the program run in it.

use dgmpm::parts::io::snapshot::{self, Snapshot};
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

/// A bar of 4 x 2 cells against a wall: 10 to 20 steps of degree 1.
pub const SCENE: &str = r#"title = "small impact"
[mesh]
rectangle = { size = [1.0, 0.5], cells = [4, 2] }
[[material]]
group = "body"
law = "neo-hookean"
young = 2e11
poisson = 0.3
density = 7800.0
[initial]
velocity = ["-200", "0"]
[[boundary]]
group = "left"
kind = "wall"
[[boundary]]
group = "right"
kind = "free"
[[boundary]]
group = "bottom"
kind = "symmetry"
[[boundary]]
group = "top"
kind = "free"
[scheme]
method = "ader-dgmpm"
degree = 1
[time]
end = 1e-4
[[output]]
kind = "fields"
at = [5e-5, 1e-4]
[[output]]
kind = "line"
name = "bottom"
from = [0.0, 0.0]
to = [1.0, 0.0]
samples = 5
at = [1e-4]
"#;

/// A folder of its own for a test.
pub struct Bench {
    folder: tempfile::TempDir,
}

impl Bench {
    /// An empty folder.
    pub fn empty() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    /// A folder with [`SCENE`] as `case.toml`.
    pub fn new() -> Self {
        let bench = Self::empty();
        bench.write("case.toml", SCENE);
        bench
    }

    /// A path in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), bytes).unwrap();
    }

    /// Reads a text file.
    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap_or_else(|why| panic!("{name}: {why}"))
    }

    /// The program with arguments, separated by blanks, to be run in the folder.
    pub fn command(&self, arguments: &str) -> Command {
        // Under `nohup`, and in the background of a script, programs are started with some of these signals ignored, and it would stay so.
        let mut command = Command::new("/usr/bin/env");
        command.args(["--default-signal=INT,TERM,HUP", env!("CARGO_BIN_EXE_dgmpm")]);
        command.current_dir(self.folder.path()).args(arguments.split_whitespace());
        // Tests start programs side by side: one that is just being started holds the files that this process had open, with their locks.
        command.env("HDF5_USE_FILE_LOCKING", "FALSE");
        command
    }

    fn output(&self, arguments: &str) -> (Output, String) {
        let output = self.command(arguments).output().unwrap();
        let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
        let said = text(&output.stdout) + &text(&output.stderr);
        assert!(!said.contains("panicked"), "dgmpm {arguments}\n{said}");
        (output, said)
    }

    /// Runs it, which must succeed; what it said.
    pub fn run(&self, arguments: &str) -> String {
        let (output, said) = self.output(arguments);
        assert!(output.status.success(), "dgmpm {arguments}: {}\n{said}", output.status);
        said
    }

    /// Runs it, which must end with this exit code; the last message on standard error.
    pub fn fail(&self, code: i32, arguments: &str) -> String {
        let (output, said) = self.output(arguments);
        assert_eq!(output.status.code(), Some(code), "dgmpm {arguments}\n{said}");
        let errors = String::from_utf8_lossy(&output.stderr).into_owned();
        let at = errors.rfind("error: ").unwrap_or_else(|| panic!("dgmpm {arguments}: no message\n{said}"));
        errors[at..].to_owned()
    }

    /// Snapshots of a run folder, in the order of steps.
    pub fn snapshots(&self, run: &str) -> Vec<Snapshot> {
        let files = snapshot::list(&self.path(run).join("snapshots")).unwrap();
        files.iter().map(|(_, path)| Snapshot::read(path).unwrap()).collect()
    }

    /// The last state of a run folder.
    pub fn last(&self, run: &str) -> Snapshot {
        self.snapshots(run).pop().expect("a snapshot")
    }

    /// `summary.json` of a run folder.
    pub fn summary(&self, run: &str) -> serde_json::Value {
        serde_json::from_str(&self.read(&format!("{run}/summary.json"))).unwrap()
    }

    /// Header and rows of a CSV file.
    pub fn table(&self, name: &str) -> (Vec<String>, Vec<Vec<f64>>) {
        let text = self.read(name);
        let mut lines = text.lines();
        let header = lines.next().unwrap().split(',').map(str::to_owned).collect();
        (header, lines.map(|line| line.split(',').map(|word| word.parse().unwrap()).collect()).collect())
    }
}

/// All files below a folder with their bytes, sorted.
pub fn tree(folder: &Path) -> Vec<(PathBuf, Vec<u8>)> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(tree(&path));
        } else {
            files.push((path.clone(), std::fs::read(&path).unwrap()));
        }
    }
    files.sort();
    files
}

/// The bits of numbers: equal also where they are NaN, unequal for 0 and -0.
pub fn bits(values: &[f64]) -> Vec<u64> {
    values.iter().map(|v| v.to_bits()).collect()
}
