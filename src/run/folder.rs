//! The folder of a run: which file lies where.

use crate::error::Error;
use std::path::{Path, PathBuf};

/// `runs/<scene>/`: `scene.toml mesh.h5 cloud.h5 operators.h5 snapshots/ lines/ tracks/ ledger.csv summary.json export/`, and after
/// regrids `regrid.csv mesh_<step>.h5 cloud_<step>.h5`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Folder {
    /// The folder itself.
    pub root: PathBuf,
}

impl Folder {
    /// A folder that may or may not exist.
    pub fn new(root: &Path) -> Self {
        Self { root: root.to_owned() }
    }

    /// The scene as run.
    pub fn scene(&self) -> PathBuf {
        self.root.join("scene.toml")
    }

    /// The mesh.
    pub fn mesh(&self) -> PathBuf {
        self.root.join("mesh.h5")
    }

    /// The cloud.
    pub fn cloud(&self) -> PathBuf {
        self.root.join("cloud.h5")
    }

    /// The stored matrices.
    pub fn operators(&self) -> PathBuf {
        self.root.join("operators.h5")
    }

    /// Snapshots.
    pub fn snapshots(&self) -> PathBuf {
        self.root.join("snapshots")
    }

    /// Samples along a line.
    pub fn line(&self, name: &str) -> PathBuf {
        self.root.join("lines").join(format!("{name}.csv"))
    }

    /// Numbers through time.
    pub fn track(&self, name: &str) -> PathBuf {
        self.root.join("tracks").join(format!("{name}.csv"))
    }

    /// Energy and momentum over time.
    pub fn ledger(&self) -> PathBuf {
        self.root.join("ledger.csv")
    }

    /// What regrids did.
    pub fn regrids(&self) -> PathBuf {
        self.root.join("regrid.csv")
    }

    /// Meshes and clouds of regrids of an earlier run.
    fn later_grids(&self) -> Vec<PathBuf> {
        let is_one = |name: &str| {
            let rest = name.strip_prefix("mesh_").or_else(|| name.strip_prefix("cloud_"))?.strip_suffix(".h5")?;
            rest.bytes().all(|c| c.is_ascii_digit()).then_some(())
        };
        let entries = std::fs::read_dir(&self.root).into_iter().flatten().flatten();
        entries
            .map(|entry| entry.path())
            .filter(|p| p.file_name().and_then(|n| is_one(n.to_str()?)).is_some())
            .collect()
    }

    /// Figures of the run.
    pub fn summary(&self) -> PathBuf {
        self.root.join("summary.json")
    }

    /// Files for other programs.
    pub fn export(&self) -> PathBuf {
        self.root.join("export")
    }

    /// Results of an earlier run that are there.
    fn results(&self) -> impl Iterator<Item = PathBuf> {
        let [lines, tracks] = ["lines", "tracks"].map(|name| self.root.join(name));
        let all = [self.snapshots(), lines, tracks, self.ledger(), self.regrids(), self.summary(), self.export()];
        all.into_iter().filter(|path| path.exists()).chain(self.later_grids())
    }

    /// Refuses a folder with results of an earlier run; changes nothing.
    ///
    /// # Errors
    /// Bad input, which names what is there.
    pub fn refuse_results(&self) -> Result<(), Error> {
        let Some(path) = self.results().next() else { return Ok(()) };
        Err(Error::input(
            format!("{} holds results of an earlier run ({})", self.root.display(), path.display()),
            "give --force to replace them, or another folder by --out",
        ))
    }

    /// Makes the folder ready for results: those of an earlier run are removed.
    ///
    /// # Errors
    /// A folder that cannot be made, a result that cannot be removed.
    pub fn clear_results(&self) -> Result<(), Error> {
        for path in &self.results().collect::<Vec<_>>() {
            let removed = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
            removed.map_err(|why| Error::output(path, why))?;
        }
        std::fs::create_dir_all(self.snapshots()).map_err(|why| Error::output(&self.root, why))
    }
}
