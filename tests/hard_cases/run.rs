//! One run of the program, whatever its exit code.

use super::runs::Table;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::time::Instant;
use tempfile::TempDir;

/// A run that has ended.
pub struct Finished {
    scene: PathBuf,
    sets: Vec<String>,
    folder: TempDir,
    /// Exit code.
    pub code: Option<i32>,
    /// What it wrote on stderr.
    pub message: String,
    /// `summary.json`, or null.
    pub summary: serde_json::Value,
    /// Wall seconds.
    pub seconds: f64,
}

fn start(scene: &Path, sets: &[String], out: &Path) -> Output {
    let mut command = Command::new(env!("CARGO_BIN_EXE_dgmpm"));
    command.arg("run").arg(scene).args(["--force", "--threads", "1", "--out"]).arg(out);
    sets.iter().for_each(|set| {
        command.args(["--set", set]);
    });
    // Programs run side by side: one that is just being started holds the files that this process had open, with their locks.
    command.env("HDF5_USE_FILE_LOCKING", "FALSE").output().unwrap()
}

impl Finished {
    /// Runs a scene of `meshes/hard/` with overrides.
    pub fn of(scene: &str, sets: &[String]) -> Self {
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join(format!("meshes/hard/{scene}.toml"));
        let folder = tempfile::tempdir().unwrap();
        let begin = Instant::now();
        let output = start(&scene, sets, folder.path());
        let seconds = begin.elapsed().as_secs_f64();
        let summary = std::fs::read_to_string(folder.path().join("summary.json"));
        let summary = summary.map_or(serde_json::Value::Null, |text| serde_json::from_str(&text).unwrap());
        let message = String::from_utf8_lossy(&output.stderr).into_owned();
        Self { scene, sets: sets.to_vec(), folder, code: output.status.code(), message, summary, seconds }
    }

    /// Exit code of a run that starts from the state that this one has kept, to a time.
    pub fn goes_on(&self, end: f64) -> Option<i32> {
        let kept = self.summary["loss"]["kept_step"].as_u64()?;
        let file = self.folder.path().join(format!("snapshots/{kept:06}.h5"));
        let more = [format!("initial={{snapshot={file:?}}}"), format!("time.end={end:e}")];
        let sets = [&self.sets[..], &more].concat();
        start(&self.scene, &sets, &self.folder.path().join("on")).status.code()
    }

    /// A number of the summary, by the keys that lead to it; NaN where it is not there.
    pub fn number(&self, keys: &[&str]) -> f64 {
        keys.iter().fold(&self.summary, |value, key| &value[*key]).as_f64().unwrap_or(f64::NAN)
    }

    /// `ledger.csv`.
    pub fn ledger(&self) -> Table {
        Table::read(&self.folder.path().join("ledger.csv"))
    }

    /// `lines/<name>.csv`, all times.
    pub fn line(&self, name: &str) -> Table {
        Table::read(&self.folder.path().join(format!("lines/{name}.csv")))
    }
}
