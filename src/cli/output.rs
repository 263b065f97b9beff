//! Where results go, and on how many threads a run is stepped.

use super::print::note;
use crate::format::count;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// Where a run's results go, and on how many threads it runs.
#[derive(Debug, Clone, clap::Args)]
pub struct RunArgs {
    /// Folder for the results [default: runs/<scene name>]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
    /// Replace results of an earlier run
    #[arg(long)]
    pub force: bool,
    /// Threads [default: all processors]; the results do not depend on it
    #[arg(long, value_name = "N")]
    pub threads: Option<usize>,
    /// Instruction set: avx512, avx2 or portable [default: the widest of this processor]; results differ in the last digits
    #[arg(long, value_name = "NAME")]
    pub kernel: Option<String>,
}

impl RunArgs {
    /// The folder, `runs/<scene name>` by default.
    pub fn folder(&self, scene: &Scene) -> Folder {
        let default = || Path::new("runs").join(scene.name());
        Folder::new(&self.out.clone().unwrap_or_else(default))
    }
}

/// Names what stays of the files in the folders of results.
pub fn kept_files(files: &[PathBuf]) {
    if let Some(first) = files.first() {
        note(format!("{} that dgmpm has not made, such as {}: kept", count(files.len(), "file"), first.display()));
    }
}
