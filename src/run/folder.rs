//! The folder of a run: which file lies where.

use super::lock::{self, Lock};
use crate::error::Error;
use crate::io::{own, pending};
use std::path::{Path, PathBuf};

/// `runs/<scene>/`: `scene.toml mesh.h5 cloud.h5 operators.h5 snapshots/ lines/ tracks/ ledger.csv summary.json export/`, after
/// regrids `regrid.csv mesh_<step>.h5 cloud_<step>.h5`, and `checkpoints/`. The file `.dgmpm` is the list of what the program has made
/// there ([`own`]) and bears the lock of a run.
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

    /// Figures of the run.
    pub fn summary(&self) -> PathBuf {
        self.root.join(SUMMARY)
    }

    /// Files for other programs.
    pub fn export(&self) -> PathBuf {
        self.root.join("export")
    }

    /// Pictures.
    pub fn plots(&self) -> PathBuf {
        self.root.join(PLOTS)
    }

    /// Checkpoints.
    pub fn checkpoints(&self) -> PathBuf {
        self.root.join(CHECKPOINTS)
    }

    /// Files of an earlier run that are there and that a new one takes the place of, by the list of the folder.
    fn results(&self) -> Vec<String> {
        let there = |name: &String| is_result(name) && self.root.join(name).symlink_metadata().is_ok();
        own::read(&self.root).into_iter().filter(there).collect()
    }

    /// Whether dgmpm keeps a list of its files there: the folder is that of a run of this version.
    pub fn has_list(&self) -> bool {
        self.root.join(own::LIST).is_file()
    }

    /// Files under names that a run writes to, and that are there without being on the list: files of the user.
    pub fn foreign(&self) -> Vec<String> {
        let own = own::read(&self.root);
        self.files().into_iter().filter(|name| is_reserved(name) && !own.contains(name)).collect()
    }

    /// Whether a run that begins in the folder removes a file or may write another one in its place.
    pub fn takes(&self, file: &Path) -> bool {
        let (Ok(root), Ok(file)) = (self.root.canonicalize(), file.canonicalize()) else { return false };
        let name = file.strip_prefix(root).ok().and_then(Path::to_str);
        name.is_some_and(|name| is_reserved(name) || self.results().iter().any(|result| result == name))
    }

    /// The names of all files in the folder and in the folders in it.
    fn files(&self) -> Vec<String> {
        let list = |folder: &Path| std::fs::read_dir(folder).into_iter().flatten().flatten().collect::<Vec<_>>();
        let mut out = Vec::new();
        for entry in list(&self.root) {
            let Ok(name) = entry.file_name().into_string() else { continue };
            match entry.path().is_dir() {
                true => {
                    let below = list(&entry.path()).into_iter().filter_map(|file| file.file_name().into_string().ok());
                    out.extend(below.map(|file| format!("{name}/{file}")));
                }
                false => out.push(name),
            }
        }
        out.sort();
        out
    }

    /// Takes the folder for a run: it is made where it is missing, and nobody else can take it until the lock is dropped.
    ///
    /// # Errors
    /// Another run has it; a folder that cannot be made or written to.
    pub fn lock(&self) -> Result<Lock, Error> {
        Lock::take(&self.root)
    }

    /// Whether the run in the folder came to its end, with all its rows, by its summary.
    pub fn is_done(&self) -> bool {
        let text = std::fs::read_to_string(self.summary()).unwrap_or_default();
        serde_json::from_str::<serde_json::Value>(&text).is_ok_and(|summary| summary["status"] == "done")
    }

    /// Whether a run is writing into the folder.
    pub fn is_taken(&self) -> bool {
        lock::is_taken(&self.root)
    }

    /// Refuses a folder with results of an earlier run; changes nothing.
    ///
    /// # Errors
    /// Bad input, which names what is there.
    pub fn refuse_results(&self) -> Result<(), Error> {
        let Some(name) = self.results().into_iter().next() else { return Ok(()) };
        Err(Error::input(
            format!("{} holds results of an earlier run ({})", self.root.display(), self.root.join(name).display()),
            "give --force to replace them, or another folder by --out",
        ))
    }

    /// Makes the folder ready for results: those of an earlier run are removed, by the list of the folder. Answers the files in the
    /// folders of results that stay, as the program has not made them.
    ///
    /// # Errors
    /// A folder that cannot be made, a result that cannot be removed.
    pub fn clear_results(&self) -> Result<Vec<PathBuf>, Error> {
        for name in self.results_from_the_summary_on() {
            let path = self.root.join(name);
            std::fs::remove_file(&path).map_err(|why| Error::output(&path, why))?;
        }
        self.remove_parts();
        let fail = |why| Error::output(&self.root, why);
        std::fs::create_dir_all(&self.root).map_err(fail)?;
        if self.root.join(own::LIST).exists() {
            own::shorten(&self.root)?;
        } else {
            std::fs::write(self.root.join(own::LIST), "").map_err(fail)?;
        }
        for folder in FOLDERS.iter().map(|name| self.root.join(name)) {
            // One that is not empty stays.
            let _ = std::fs::remove_dir(folder);
        }
        std::fs::create_dir_all(self.snapshots()).map_err(fail)?;
        let is_left = |name: &String| FOLDERS.iter().any(|folder| name.starts_with(&format!("{folder}/")));
        Ok(self.files().into_iter().filter(is_left).map(|name| self.root.join(name)).collect())
    }

    /// The results in the order in which they are removed: where that is interrupted, no summary says of what is left that it is done.
    fn results_from_the_summary_on(&self) -> Vec<String> {
        let mut results = self.results();
        results.sort_by_key(|name| name != SUMMARY);
        results
    }

    /// Removes what a killed run has left of files that it was writing.
    pub fn remove_parts(&self) {
        for name in self.files() {
            if pending::target_of_part(&name).is_some_and(|target| is_result(target) || is_input(target)) {
                let _ = std::fs::remove_file(self.root.join(name));
            }
        }
    }

    /// Removes the snapshots of a run from a step on (behind it `with_snapshot`, where that of the step stays), grids that came in later, and the summary: a run that goes on makes them anew.
    ///
    /// # Errors
    /// A file that cannot be removed.
    pub fn cut_back(&self, step: usize, with_snapshot: bool) -> Result<(), Error> {
        self.remove_parts();
        for name in self.results_from_the_summary_on() {
            // A grid at the step is the one that the run goes on with.
            let first = if name.starts_with("snapshots/") && !with_snapshot { step } else { step + 1 };
            if step_of(&name).is_some_and(|of| of >= first) || name == SUMMARY {
                let path = self.root.join(&name);
                std::fs::remove_file(&path).map_err(|why| Error::output(&path, why))?;
            }
        }
        if self.root.join(own::LIST).exists() {
            own::shorten(&self.root)?;
        }
        std::fs::create_dir_all(self.snapshots()).map_err(|why| Error::output(&self.root, why))
    }
}

const CHECKPOINTS: &str = "checkpoints";
const PLOTS: &str = "plots";
const SUMMARY: &str = "summary.json";
/// Folders of results.
const FOLDERS: [&str; 6] = ["snapshots", "lines", "tracks", "export", PLOTS, CHECKPOINTS];

/// The step in the name of a snapshot or of a grid that came in by a regrid.
fn step_of(name: &str) -> Option<usize> {
    let stems = ["snapshots/", "mesh_", "cloud_"];
    let rest = stems.iter().find_map(|stem| name.strip_prefix(stem))?.strip_suffix(".h5")?;
    rest.bytes().all(|c| c.is_ascii_digit()).then(|| rest.parse().ok()).flatten()
}

/// Whether a file that the program has made is a result.
fn is_result(name: &str) -> bool {
    let in_folder = FOLDERS.iter().any(|folder| name.strip_prefix(folder).is_some_and(|rest| rest.starts_with('/')));
    ["ledger.csv", "regrid.csv", SUMMARY].contains(&name) || step_of(name).is_some() || in_folder
}

/// Whether a run may write a file of this name, or reads all files with such names; names that outputs have are not among them.
fn is_reserved(name: &str) -> bool {
    ["ledger.csv", "regrid.csv", SUMMARY].contains(&name) || step_of(name).is_some() || is_input(name)
}

/// Whether a run may write its input under this name.
fn is_input(name: &str) -> bool {
    let numbered = |stem: &str, ending: &str| {
        let rest = name.strip_prefix(stem).and_then(|rest| rest.strip_suffix(ending));
        rest.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    };
    ["scene.toml", "mesh.h5", "cloud.h5", "operators.h5", "initial.h5", "initial.vtu"].contains(&name)
        || numbered("boundary_", ".csv")
        || numbered("regrid_", ".h5")
        || numbered("regrid_", ".geo")
}
