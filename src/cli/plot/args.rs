//! Arguments of `dgmpm plot`.

use super::format::Format;
use crate::error::{Error, Result};
use crate::picture::When;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square
    pub run: PathBuf,
    /// Fields of the maps, separated by commas, such as von_mises,pressure,speed,cauchy_stress_11 [default: those of a first look]
    #[arg(long, value_name = "NAME,..", value_delimiter = ',')]
    pub field: Vec<String>,
    /// The snapshot after this step [default: the last one]
    #[arg(long, value_name = "N", conflicts_with_all = ["time", "all"])]
    pub step: Option<usize>,
    /// The snapshot nearest to this time, s
    #[arg(long, value_name = "T", conflicts_with = "all", allow_negative_numbers = true)]
    pub time: Option<f64>,
    /// All snapshots, with the same colours
    #[arg(long)]
    pub all: bool,
    /// On the initial body, and not on the deformed one
    #[arg(long)]
    pub initial: bool,
    /// The numbers at both ends of the colours, in the unit without a prefix [default: smallest and largest]
    #[arg(long, value_name = "A,B", value_delimiter = ',', allow_hyphen_values = true, requires = "field")]
    pub range: Vec<f64>,
    /// Format of the pictures
    #[arg(long, value_enum, default_value_t = Format::Png)]
    pub format: Format,
    /// Folder for the pictures [default: plots/ in the folder of the run]
    #[arg(long, value_name = "DIR")]
    pub out: Option<PathBuf>,
}

impl Args {
    /// Which snapshots are drawn.
    pub fn when(&self) -> When {
        let time = self.time.map_or(When::End, When::Time);
        if self.all { When::All } else { self.step.map_or(time, When::Step) }
    }

    /// Whether maps are named, and no curves are wanted.
    pub fn wants_maps(&self) -> bool {
        !self.field.is_empty() || self.when() != When::End
    }

    /// The ends of the colours, where they are given.
    pub fn range(&self) -> Result<Option<[f64; 2]>> {
        match self.range[..] {
            [] => Ok(None),
            [low, high] if low < high && (high - low).is_finite() => Ok(Some([low, high])),
            _ => Err(Error::input("--range is not two rising numbers", "give for instance --range=-2e8,2e8")),
        }
    }
}
