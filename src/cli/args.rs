//! Arguments that several subcommands share.

use crate::error::Result;
use crate::problem::Files;
use crate::scene::Scene;
use std::path::PathBuf;

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
