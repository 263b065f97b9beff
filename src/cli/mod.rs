//! The program: one file a subcommand, arguments and `run`.

mod args;
mod bench;
mod export;
mod interrupt;
mod mesh;
mod preprocess;
mod print;
mod progress;
mod regrid;
mod report;
mod run;
mod seed;
mod solve;
mod stability;
mod study;
mod summary;
mod threads;

use crate::error::Result;
use clap::{Parser, Subcommand};
use std::process::ExitCode;

const AFTER_HELP: &str = "\
All in one go:
  dgmpm run square.toml --set scheme.degree=1 --out runs/square
  dgmpm export runs/square

Stage by stage, each from files:
  dgmpm mesh square.msh
  dgmpm seed square.toml --mesh square.h5 --out cloud.h5
  dgmpm preprocess square.toml --mesh square.h5 --cloud cloud.h5 --out operators.h5
  dgmpm solve square.toml --mesh square.h5 --cloud cloud.h5 --operators operators.h5

Exit codes: 0 done, 2 bad input, 3 the run lost stability, 4 interrupted and saved, 5 output could not be written.";

/// ADER Discontinuous Galerkin Material Point Method for fast, large-deformation solid dynamics.
#[derive(Debug, Parser)]
#[command(version, about, after_help = AFTER_HELP, infer_subcommands = false)]
pub struct Cli {
    #[command(subcommand)]
    command: Command,
}

// Parsed once: its size costs nothing.
#[allow(clippy::large_enum_variant)]
#[derive(Debug, Subcommand)]
enum Command {
    /// Import, make or inspect a mesh of quadrilaterals
    Mesh(mesh::Args),
    /// Put material points into the cells of a mesh
    Seed(seed::Args),
    /// Compute and store all matrices, and say what the run will cost
    Preprocess(preprocess::Args),
    /// Step the conservation laws, from stored files where they are given
    Solve(solve::Args),
    /// Run a scene: mesh, seed, preprocess and solve in one go
    Run(run::Args),
    /// Show what accuracy costs in time: methods, degrees and meshes on one problem
    Study(study::Args),
    /// Tell how perturbations of a state grow: spectrum of the linearised step of a patch or a small body
    Stability(stability::Args),
    /// Measure the speed of the step against the peaks of this machine
    Bench(bench::Args),
    /// Bring a stopped run to another mesh
    Regrid(regrid::Args),
    /// Write a run's snapshots for ParaView, meshio and DOLFINx
    Export(export::Args),
}

/// Parses the command line of the process and runs it; the message of an error goes to standard error.
pub fn main() -> ExitCode {
    let outcome = match Cli::try_parse() {
        Ok(cli) => run(cli),
        // Help, the version, or a wrong argument, in clap's words and with its exit code, 0 or 2.
        Err(said) => {
            print::printed(said.print());
            match print::all_printed() {
                Ok(()) => return ExitCode::from(u8::try_from(said.exit_code()).unwrap_or(2)),
                // Where a message on standard error is lost, the code of the error itself stands.
                Err(_) if said.use_stderr() => return ExitCode::from(2),
                Err(error) => Err(error),
            }
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Nobody may read along: the exit code stands.
            print::complain(&error);
            ExitCode::from(error.exit_code())
        }
    }
}

/// Runs a parsed command line.
///
/// # Errors
/// The one message for the user; its exit code is [`crate::Error::exit_code`].
pub fn run(cli: Cli) -> Result<()> {
    command(cli).and_then(|()| print::all_printed())
}

fn command(cli: Cli) -> Result<()> {
    match cli.command {
        Command::Mesh(args) => mesh::run(&args),
        Command::Seed(args) => seed::run(&args),
        Command::Preprocess(args) => preprocess::run(&args),
        Command::Solve(args) => solve::run(&args),
        Command::Run(args) => run::run(&args),
        Command::Study(args) => study::run(&args),
        Command::Stability(args) => stability::run(&args),
        Command::Bench(args) => bench::run(&args),
        Command::Regrid(args) => regrid::run(&args),
        Command::Export(args) => export::run(&args),
    }
}
