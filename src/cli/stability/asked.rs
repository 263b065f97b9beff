//! What is asked of each case.

use crate::error::{Error, Result};
use crate::stability::Questions;

#[derive(Debug, clap::Args)]
pub struct Asked {
    /// The limit dt -> 0 in place of a step
    #[arg(long)]
    pub semi_discrete: bool,
    /// Look for the largest stable step, too
    #[arg(long)]
    limit: bool,
    /// Growth of the largest number over 1, 10 and 100 steps, too
    #[arg(long)]
    norms: bool,
    /// Bloch angles a direction
    #[arg(long, value_name = "N", default_value_t = 12)]
    angles: usize,
}

impl Asked {
    /// As the library has it.
    pub fn questions(&self) -> Result<Questions> {
        if self.angles < 2 {
            return Err(Error::input(format!("--angles is {}", self.angles), "give a number from 2"));
        }
        Ok(Questions { angles: self.angles, limit: self.limit, norms: self.norms })
    }
}
