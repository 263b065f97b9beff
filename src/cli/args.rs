//! Arguments that several subcommands share.

use super::threads::start_threads;
use crate::error::{Error, Result};
use crate::problem::Files;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::{Path, PathBuf};

/// The scene of a command, with its overrides.
#[derive(Debug, clap::Args)]
pub struct SceneArgs {
    /// Scene file (TOML)
    pub scene: PathBuf,
    /// Override a key, as often as needed: scheme.degree=3, boundary.0.kind=free, time.end=1e-4
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
}

impl SceneArgs {
    /// Reads it.
    pub fn load(&self) -> Result<Scene> {
        Scene::load(&self.scene, &self.sets)
    }
}

/// Files of earlier stages; what is not given is made from the scene.
#[derive(Debug, Default, clap::Args)]
pub struct FileArgs {
    /// Mesh file in place of the scene's
    #[arg(long, value_name = "FILE")]
    pub mesh: Option<PathBuf>,
    /// Cloud file in place of the scene's
    #[arg(long, value_name = "FILE")]
    pub cloud: Option<PathBuf>,
}

impl FileArgs {
    /// As the library has them.
    pub fn files(&self) -> Files {
        Files { mesh: self.mesh.clone(), cloud: self.cloud.clone() }
    }
}

/// Where a run's results go, and on how many threads it runs.
#[derive(Debug, clap::Args)]
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

    /// Starts the threads.
    pub fn start_threads(&self) -> Result<()> {
        self.threads.map_or(Ok(()), start_threads)
    }
}

/// Refuses to write over a file unless `force`.
pub fn keep(path: &Path, force: bool) -> Result<()> {
    if path.exists() && !force {
        return Err(Error::input(format!("{} exists", path.display()), "give --force to replace it, or another --out"));
    }
    Ok(())
}
