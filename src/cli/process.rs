//! From the command line of the process to its exit code.

use super::print::Manner;
use super::{Cli, interrupt, print};
use crate::error::Result;
use crate::file::seal;
use clap::Parser;
use std::process::ExitCode;

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
    interrupt::outlive_large_files();
    if cli.trust {
        seal::trust();
    }
    print::speak(match (cli.quiet, cli.json) {
        (_, true) => Manner::Json,
        (true, _) => Manner::Quiet,
        _ => Manner::Plain,
    });
    cli.command.run().and_then(|()| print::all_printed())
}
