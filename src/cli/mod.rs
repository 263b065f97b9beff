//! The program: one file or folder a subcommand, arguments and `run`.

mod args;
mod bench;
mod check;
mod command;
mod effects;
mod export;
mod interrupt;
mod mesh;
mod output;
mod pipeline;
mod preprocess;
mod print;
mod process;
mod progress;
mod regrid;
mod report;
mod resume;
mod run;
mod seed;
mod solve;
mod stability;
mod study;
mod summary;
mod threads;
mod verify;

pub use process::main;

use clap::Parser;

const AFTER_HELP: &str = "\
All in one go:
  dgmpm run square.toml --set scheme.degree=1 --out runs/square
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
    command: command::Command,
    /// Read HDF5 files without a seal of dgmpm too: only those of a writer that means no harm
    #[arg(long, global = true)]
    trust: bool,
}
