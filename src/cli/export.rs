//! `dgmpm export`: a run's snapshots for ParaView, meshio and DOLFINx.

use super::print::say;
use crate::error::Result;
use crate::format::count;
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
    /// Show grid and points where they are at each time, X + u, in files whose names end in _deformed [default: in the initial
    /// configuration, X]
    #[arg(long)]
    deformed: bool,
}

/// What is written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, clap::ValueEnum)]
pub enum Format {
    /// VTU of grid and material points, with .pvd series
    Vtu,
    /// XDMF + HDF5 time series, and the mesh alone
    Xdmf,
    /// VTKHDF of grid and material points, a file for all times: ParaView 5.12 or later
    Vtkhdf,
}

impl std::fmt::Display for Format {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Format::Vtu => "vtu",
            Format::Xdmf => "xdmf",
            Format::Vtkhdf => "vtkhdf",
        })
    }
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let export = Export::new(&Folder::new(&args.run))?;
    let export = if args.deformed { export.deformed() } else { export };
    for format in &args.format {
        match format {
            Format::Vtu => export.vtu()?,
            Format::Xdmf => export.xdmf()?,
            Format::Vtkhdf => export.vtkhdf()?,
        }
    }
    say(format!("{} exported to {}", count(export.count(), "snapshot"), export.out().display()));
    Ok(())
}
