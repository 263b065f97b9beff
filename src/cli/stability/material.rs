//! The state and the materials.

use crate::error::{Error, Result};
use crate::stability::Pattern;

#[derive(Debug, clap::Args)]
pub struct Material {
    /// The state F0 [default: the initial one of the scene, else 1,0,0,1]
    #[arg(long, value_name = "F11,F12,F21,F22", allow_hyphen_values = true)]
    pub deformation: Option<String>,
    /// Constitutive law [default: neo-hookean]
    #[arg(long, value_name = "NAME")]
    law: Option<String>,
    /// Young's modulus [default: 1]
    #[arg(long, value_name = "E")]
    young: Option<String>,
    /// Poisson's ratio [default: 0.3]
    #[arg(long, value_name = "NU")]
    poisson: Option<String>,
    /// Density [default: 1]
    #[arg(long, value_name = "RHO")]
    density: Option<String>,
    /// Two materials: ratio of their Young's moduli
    #[arg(long, value_name = "RATIO", conflicts_with = "scene")]
    contrast: Option<String>,
    /// Where the stiffer one is: checkerboard, or halves [default: checkerboard]
    #[arg(long, value_name = "NAME")]
    pattern: Option<String>,
}

impl Material {
    /// Keys with their lists.
    pub fn lists(&self) -> [(&'static str, &Option<String>); 5] {
        [
            ("law", &self.law),
            ("young", &self.young),
            ("poisson", &self.poisson),
            ("density", &self.density),
            ("contrast", &self.contrast),
        ]
    }

    /// Where the stiffer cells are, where it is given.
    pub fn pattern(&self) -> Result<Option<Pattern>> {
        let Some(name) = &self.pattern else { return Ok(None) };
        let known = Pattern::named(name);
        let unknown = || Error::input(format!("there is no pattern `{name}`"), "give checkerboard or halves");
        known.ok_or_else(unknown).map(Some)
    }
}
