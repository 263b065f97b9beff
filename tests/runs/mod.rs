//! Runs of the program on scenes, for tests that look at physics: results as a user finds them.
#![allow(dead_code)] // each test file uses its part

use std::path::{Path, PathBuf};
use std::process::Command;
use tempfile::TempDir;

/// A finished run in a folder that goes with it.
pub struct Outcome {
    folder: TempDir,
    /// `summary.json`.
    pub summary: serde_json::Value,
}

/// Runs a scene of `meshes/` with overrides, to its end.
pub fn run(scene: &str, sets: &[&str]) -> Outcome {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("meshes").join(scene);
    let folder = tempfile::tempdir().unwrap();
    let mut command = Command::new(env!("CARGO_BIN_EXE_dgmpm"));
    command.arg("run").arg(scene).arg("--force").arg("--out").arg(folder.path());
    sets.iter().for_each(|set| {
        command.args(["--set", set]);
    });
    let output = command.output().unwrap();
    assert!(output.status.success(), "{sets:?}: {}", String::from_utf8_lossy(&output.stderr));
    let text = std::fs::read_to_string(folder.path().join("summary.json")).unwrap();
    Outcome { summary: serde_json::from_str(&text).unwrap(), folder }
}

impl Outcome {
    /// The folder of the run.
    pub fn path(&self) -> PathBuf {
        self.folder.path().to_owned()
    }

    /// A number of the summary.
    pub fn number(&self, key: &str) -> f64 {
        self.summary[key].as_f64().unwrap()
    }

    /// The rows of `lines/<name>.csv` nearest to time t.
    pub fn line(&self, name: &str, t: f64) -> Table {
        let all = Table::read(&self.folder.path().join("lines").join(format!("{name}.csv")));
        let times = all.column("t");
        let nearest =
            times.iter().fold(f64::INFINITY, |best: f64, x| if (x - t).abs() < (best - t).abs() { *x } else { best });
        let rows = all.rows.into_iter().zip(times).filter(|(_, x)| *x == nearest).map(|(row, _)| row).collect();
        Table { names: all.names, rows }
    }

    /// `ledger.csv`.
    pub fn ledger(&self) -> Table {
        Table::read(&self.folder.path().join("ledger.csv"))
    }
}

/// A CSV file of numbers.
pub struct Table {
    names: Vec<String>,
    rows: Vec<Vec<f64>>,
}

impl Table {
    /// Reads it.
    pub fn read(path: &Path) -> Table {
        let text = std::fs::read_to_string(path).unwrap();
        let mut lines = text.lines();
        let names = lines.next().unwrap().split(',').map(str::to_owned).collect();
        Table { names, rows: lines.map(|line| line.split(',').map(|x| x.parse().unwrap()).collect()).collect() }
    }

    /// Whether it has a column.
    pub fn has(&self, name: &str) -> bool {
        self.names.iter().any(|n| n == name)
    }

    /// A column by its name.
    pub fn column(&self, name: &str) -> Vec<f64> {
        let k = self.names.iter().position(|n| n == name).unwrap_or_else(|| panic!("no column {name}"));
        self.rows.iter().map(|row| row[k]).collect()
    }
}

/// Smallest and largest.
pub fn range(values: &[f64]) -> [f64; 2] {
    values.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |[lo, hi], x| [lo.min(*x), hi.max(*x)])
}

/// |a - b| / |b| in the Euclidean norm.
pub fn relative(a: &[f64], b: &[f64]) -> f64 {
    let square = |v: &mut dyn Iterator<Item = f64>| v.map(|x| x * x).sum::<f64>();
    (square(&mut a.iter().zip(b).map(|(a, b)| a - b)) / square(&mut b.iter().copied())).sqrt()
}
