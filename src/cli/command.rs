//! The subcommands.
use super::*;
use clap::Subcommand;

/// A subcommand with its arguments.
#[allow(clippy::large_enum_variant)] // Parsed once: its size costs nothing.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Import, make or inspect a mesh of quadrilaterals
    Mesh(mesh::Args),
    /// Write a first scene, with comments, for a mesh or a Gmsh geometry
    New(new::Args),
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
    /// Draw maps of fields and curves of tables of a run, as PNG or SVG
    Plot(plot::Args),
    /// Say what a file or a folder holds
    Info(info::Args),
    /// Write a run's snapshots for ParaView, meshio and DOLFINx
    Export(export::Args),
    /// Print the JSON schema of scenes, by which editors complete and check them
    Schema,
    /// Print what a shell needs to complete the words of a command
    Completions(pages::Completions),
    /// Write a manual page for each command
    Man(pages::Man),
}

impl Command {
    /// Whether all ranks carry it out; of any other command rank 0 does.
    pub fn is_shared(&self) -> bool {
        matches!(self, Self::Run(_) | Self::Solve(_) | Self::Resume(_))
    }
}
