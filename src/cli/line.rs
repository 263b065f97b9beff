//! The command line as a whole: the words of its help, and the options of all subcommands.

use super::command::Command;
use clap::Parser;

const AFTER_HELP: &str = "\
The first hour: a scene for a mesh, its run, and its pictures:
  dgmpm new square.msh
  dgmpm run square.toml
  dgmpm plot runs/square

For ParaView, meshio and DOLFINx:
  dgmpm export runs/square

Stage by stage, each from files:
  dgmpm mesh square.msh
  dgmpm seed square.toml --mesh square.h5 --out cloud.h5
  dgmpm preprocess square.toml --mesh square.h5 --cloud cloud.h5 --out operators.h5
  dgmpm solve square.toml --mesh square.h5 --cloud cloud.h5 --operators operators.h5

After an interruption, or to a later end; and whether all files are whole:
  dgmpm resume runs/square
  dgmpm verify runs/square

Exit codes: 0 done, 2 bad input, 3 the run lost stability, 4 interrupted and saved, 5 output could not be written,
6 a folder is not whole or has other bits (verify).";

/// ADER Discontinuous Galerkin Material Point Method for fast, large-deformation solid dynamics.
#[derive(Debug, Parser)]
#[command(version, about, after_help = AFTER_HELP, infer_subcommands = false)]
pub struct Cli {
    #[command(subcommand)]
    pub command: Command,
    /// Read HDF5 files without a seal of dgmpm too: only those of a writer that means no harm
    #[arg(long, global = true)]
    pub trust: bool,
    /// Say nothing but warnings, errors, and what the command is asked for
    #[arg(long, global = true)]
    pub quiet: bool,
    /// Say all as JSON on standard output, one object a line
    #[arg(long, global = true)]
    pub json: bool,
}
