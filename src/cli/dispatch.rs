//! From a subcommand to what it does.

use super::command::Command;
use super::print::{self, Manner};
use super::*;
use crate::error::Result;
use crate::file::seal;

impl Command {
    /// Runs the command; an error is the one message for the user.
    pub fn run(self) -> Result<()> {
        match self {
            Command::Mesh(args) => mesh::run(&args),
            Command::New(args) => new::run(&args),
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
            Command::Plot(args) => plot::run(&args),
            Command::Info(args) => info::run(&args),
            Command::Export(args) => export::run(&args),
            Command::Schema => pages::schema(),
            Command::Completions(args) => pages::completions(&args),
            Command::Man(args) => pages::man(&args),
        }
    }
}

impl Cli {
    /// Runs a parsed command line; of several ranks all of them or the first one.
    pub fn run(self) -> Result<()> {
        interrupt::outlive_large_files();
        if self.trust {
            seal::trust();
        }
        print::speak(match (self.quiet, self.json) {
            (_, true) => Manner::Json,
            (true, _) => Manner::Quiet,
            _ => Manner::Plain,
        });
        let shared = self.command.is_shared();
        let run = || self.command.run().and_then(|()| print::all_printed());
        ranks::first_to_fail(if shared { run() } else { ranks::alone(run) })
    }
}
