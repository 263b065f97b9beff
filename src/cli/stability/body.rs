//! What is looked at: a patch, a rectangle or a scene.

use crate::error::{Error, Result};
use crate::scene::Scene;
use crate::stability::Domain;
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Body {
    /// Scene of a small body [default: a patch of squares without end, by Bloch angles]
    scene: Option<PathBuf>,
    /// Override a key of the scene, as often as needed
    #[arg(long = "set", value_name = "KEY=VALUE")]
    pub sets: Vec<String>,
    /// A body of so many unit squares in place of a patch
    #[arg(long, value_name = "NX,NY", value_delimiter = ',', conflicts_with = "scene")]
    body: Vec<usize>,
    /// Conditions of its sides: one kind, or left,right,bottom,top
    #[arg(long, value_name = "KIND,..", value_delimiter = ',', default_value = "free", requires = "body")]
    boundary: Vec<String>,
}

impl Body {
    /// As the library has it.
    pub fn domain(&self) -> Result<Domain> {
        if let Some(path) = &self.scene {
            return Ok(Domain::Scene(Box::new(Scene::load(path, &self.sets)?)));
        }
        let kinds = match &self.boundary[..] {
            [one] => [one, one, one, one].map(String::clone),
            [a, b, c, d] => [a, b, c, d].map(String::clone),
            _ => return Err(Error::input("--boundary is no list", "give one kind, or left,right,bottom,top")),
        };
        match self.body[..] {
            [] => Ok(Domain::Patch),
            [nx, ny] if nx > 0 && ny > 0 => Ok(Domain::Body([nx, ny], kinds)),
            _ => Err(Error::input("--body is not NX,NY", "give two numbers from 1, such as 12,1")),
        }
    }
}
