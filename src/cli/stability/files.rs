//! Where the results go.

use crate::chart;
use crate::cli::keep::keep_as;
use crate::error::Result;
use crate::io::pending::write_text;
use crate::stability::{self, Row};
use std::path::PathBuf;

#[derive(Debug, clap::Args)]
pub struct Files {
    /// Write all numbers into a CSV file
    #[arg(long, value_name = "FILE")]
    csv: Option<PathBuf>,
    /// Plot growth over the last list of numbers (svg or png)
    #[arg(long, value_name = "FILE")]
    pub plot: Option<PathBuf>,
    /// Replace files of an earlier run
    #[arg(long)]
    force: bool,
}

impl Files {
    /// Refuses files that are there, unless they may be replaced, and a plot of an unknown format.
    pub fn check(&self) -> Result<()> {
        [&self.csv, &self.plot].into_iter().flatten().try_for_each(|path| keep_as(path, self.force, "another name"))?;
        self.plot.iter().try_for_each(|path| chart::Format::of(path).map(drop))
    }

    /// Writes what is asked for.
    pub fn write(&self, rows: &[Row]) -> Result<()> {
        self.csv.iter().try_for_each(|path| write_text(path, &stability::csv(rows)))?;
        self.plot.iter().try_for_each(|path| chart::save(&stability::chart(rows)?, path))
    }
}
