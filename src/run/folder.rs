//! The folder of a run: which file lies where.

use crate::error::Error;
use std::path::{Path, PathBuf};

/// `runs/<scene>/`: `scene.toml mesh.h5 cloud.h5 operators.h5 snapshots/ lines/ ledger.csv summary.json export/`.
#[derive(Debug, Clone, PartialEq)]
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

    /// Energy and momentum over time.
    pub fn ledger(&self) -> PathBuf {
        self.root.join("ledger.csv")
    }

    /// Figures of the run.
    pub fn summary(&self) -> PathBuf {
        self.root.join("summary.json")
    }

    /// Files for other programs.
    pub fn export(&self) -> PathBuf {
        self.root.join("export")
    }

    /// Makes the folder ready for results: those of an earlier run are removed if `force`, else refused.
    ///
    /// # Errors
    /// Earlier results without `force`; a folder that cannot be made.
    pub fn clear_results(&self, force: bool) -> Result<(), Error> {
        let old = [self.snapshots(), self.root.join("lines"), self.ledger(), self.summary(), self.export()];
        for path in old.iter().filter(|path| path.exists()) {
            if !force {
                return Err(Error::input(
                    format!("{} holds results of an earlier run ({})", self.root.display(), path.display()),
                    "give --force to replace them, or another folder by --out",
                ));
            }
            let removed = if path.is_dir() { std::fs::remove_dir_all(path) } else { std::fs::remove_file(path) };
            removed.map_err(|why| Error::output(path, why))?;
        }
        std::fs::create_dir_all(self.snapshots()).map_err(|why| Error::output(&self.root, why))
    }
}
