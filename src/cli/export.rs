//! `dgmpm export`: a run's snapshots for ParaView, meshio and DOLFINx.

use super::print::say;
use crate::error::Result;
use crate::problem::Export;
use crate::run::Folder;
use std::path::PathBuf;

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    /// Folder of a run, such as runs/square; files go to its folder export/
    run: PathBuf,
    /// Formats, separated by commas
    #[arg(long, value_delimiter = ',', default_values_t = [Format::Vtu, Format::Xdmf])]
    format: Vec<Format>,
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// VTU of grid and material points, with .pvd series
    Vtu,
    /// XDMF + HDF5 time series, and the mesh alone
    Xdmf,
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(if *self == Format::Vtu { "vtu" } else { "xdmf" })
    }
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let export = Export::new(&Folder::new(&args.run))?;
    if args.format.contains(&Format::Vtu) {
        export.vtu()?;
    }
    if args.format.contains(&Format::Xdmf) {
        export.xdmf()?;
    }
    say(format!("{} snapshots exported to {}", export.count(), export.out().display()));
    Ok(())
}
