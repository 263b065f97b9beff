//! The program: one file a subcommand, arguments and `run`.

mod bench;
mod certificates;
mod export;
mod lost;
mod mesh;
mod notices;
mod pipeline;
mod preprocess;
mod print;
mod progress;
mod rebuild;
mod regrid;
mod run;
mod seed;
mod solve;
mod stability;
mod study;
mod summary;

use crate::error::{Error, Result};
use crate::lane::Kernel;
use clap::{Parser, Subcommand};
use std::path::{Path, PathBuf};
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
/// The one message for the user; its exit code is [`Error::exit_code`].
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

/// The scene of a command, with its overrides.
#[derive(Debug, clap::Args)]
struct SceneArgs {
    /// Scene file (TOML)
    scene: PathBuf,
    /// Override a key, as often as needed: scheme.degree=3, boundary.0.kind=free, time.end=1e-4
    #[arg(long = "set", value_name = "KEY=VALUE")]
    sets: Vec<String>,
}

/// Where a run's results go, and on how many threads it runs.
#[derive(Debug, clap::Args)]
struct RunArgs {
    /// Folder for the results [default: runs/<scene name>]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,
    /// Replace results of an earlier run
    #[arg(long)]
    force: bool,
    /// Threads [default: all processors]; the results do not depend on it
    #[arg(long, value_name = "N")]
    threads: Option<usize>,
    /// Instruction set: avx512, avx2 or portable [default: the widest of this processor]; results differ in the last digits
    #[arg(long, value_name = "NAME")]
    kernel: Option<String>,
}

impl RunArgs {
    /// The folder, `runs/<scene name>` by default.
    fn folder(&self, scene: &crate::scene::Scene) -> crate::run::Folder {
        let default = || Path::new("runs").join(scene.name());
        crate::run::Folder::new(&self.out.clone().unwrap_or_else(default))
    }

    /// Starts the threads.
    fn start_threads(&self) -> Result<()> {
        self.threads.map_or(Ok(()), start_threads)
    }
}

/// Threads a core that are still taken for a wish: more are a slip of the pen, and steps wait for the last of them.
const THREADS_PER_CORE: usize = 4;

/// Refuses a number of threads that this machine has no use for.
fn check_threads(threads: usize) -> Result<()> {
    // A system that does not tell refuses none.
    let cores = std::thread::available_parallelism().map_or(usize::MAX / THREADS_PER_CORE, usize::from);
    let most = THREADS_PER_CORE * cores;
    if (1..=most).contains(&threads) {
        return Ok(());
    }
    let what = match threads {
        0 => "--threads is 0".to_owned(),
        _ => format!("--threads is {threads}, and this machine has {cores} core(s)"),
    };
    Err(Error::input(what, format!("give a number of threads from 1 to {most}; {cores} use all cores")))
}

/// Starts so many threads for all that follows.
fn start_threads(threads: usize) -> Result<()> {
    check_threads(threads)?;
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build_global();
    pool.map_err(|why| Error::input(format!("cannot start {threads} threads: {why}"), "give a smaller --threads"))
}

/// The instruction set of `--kernel`; the widest of this processor where none is named.
fn kernel(name: Option<&str>) -> Result<Kernel> {
    let Some(name) = name else { return Ok(Kernel::widest()) };
    let names: Vec<&str> = Kernel::NAMES.iter().map(|(name, _)| *name).collect();
    let remedy = format!("give one of {}, or none for the widest that this processor has", names.join(", "));
    let known = Kernel::NAMES.iter().find(|(known, _)| *known == name).map(|(_, kernel)| *kernel);
    match known {
        Some(kernel) if kernel.is_available() => Ok(kernel),
        Some(_) => Err(Error::input(format!("this processor has no {name}"), remedy)),
        None => Err(Error::input(format!("there is no kernel `{name}`"), remedy)),
    }
}

/// Refuses to write over a file unless `force`.
fn keep(path: &Path, force: bool) -> Result<()> {
    if path.exists() && !force {
        return Err(Error::input(format!("{} exists", path.display()), "give --force to replace it, or another --out"));
    }
    Ok(())
}
