//! The subcommands.
use super::*;
use crate::error::Result;
use clap::Subcommand;

/// A subcommand with its arguments.
#[allow(clippy::large_enum_variant)] // Parsed once: its size costs nothing.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Import, make or inspect a mesh of quadrilaterals
    Mesh(mesh::Args),
    /// Do all of a run but its steps, and say what it will cost; nothing is written
    Check(check::Args),
    /// Put material points into the cells of a mesh
    Seed(seed::Args),
    /// Compute and store all matrices, and say what the run will cost
    Preprocess(preprocess::Args),
    /// Step the conservation laws, from stored files where they are given
    Solve(solve::Args),
    /// Run a scene: mesh, seed, preprocess and solve in one go
    Run(run::Args),
    /// Go on with a run from its last checkpoint, as if it had never stopped
    Resume(resume::Args),
    /// Tell whether the folder of a run is whole, and whether this machine gives its bits
    Verify(verify::Args),
    /// Show what accuracy costs in time: methods, degrees and meshes on one problem
    Study(study::Args),
    /// Tell how perturbations of a state grow: spectrum of the linearised step of a patch or a small body
    Stability(stability::Args),
    /// Measure the speed of the step against the peaks of this machine
    Bench(bench::Args),
    /// List what a scene can ask for, with keys, formulas and costs
    Effects(effects::Args),
    /// Bring a stopped run to another mesh
    Regrid(regrid::Args),
    /// Write a run's snapshots for ParaView, meshio and DOLFINx
    Export(export::Args),
}

impl Command {
    /// Runs the command; an error is the one message for the user.
    pub fn run(self) -> Result<()> {
        match self {
            Command::Mesh(args) => mesh::run(&args),
            Command::Check(args) => check::run(&args),
            Command::Seed(args) => seed::run(&args),
            Command::Preprocess(args) => preprocess::run(&args),
            Command::Solve(args) => solve::run(&args),
            Command::Run(args) => run::run(&args),
            Command::Resume(args) => resume::run(&args),
            Command::Verify(args) => verify::run(&args),
            Command::Study(args) => study::run(&args),
            Command::Stability(args) => stability::run(&args),
            Command::Bench(args) => bench::run(&args),
            Command::Effects(args) => effects::run(&args),
            Command::Regrid(args) => regrid::run(&args),
            Command::Export(args) => export::run(&args),
        }
    }
}
