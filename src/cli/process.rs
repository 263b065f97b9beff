//! From the command line of the process to its exit code.

use super::{Cli, print, ranks};
use crate::error::Error;
use crate::exchange::Exchange;
use clap::Parser;
use std::ffi::OsString;
use std::process::ExitCode;
use std::sync::Arc;

/// Parses the command line of the process and runs it; the message of an error goes to standard error.
pub fn main() -> ExitCode {
    told(Cli::try_parse())
}

/// The same for one of several ranks with a command line, which is that of all ranks; `threads` is the default of `--threads`.
pub fn main_on(exchange: Arc<dyn Exchange>, threads: usize, arguments: Vec<OsString>) -> ExitCode {
    ranks::join(exchange, threads);
    print::silence(!ranks::writes());
    told(Cli::try_parse_from(arguments))
}

/// Runs a command line, and tells what came of it.
fn told(parsed: std::result::Result<Cli, clap::Error>) -> ExitCode {
    let outcome = match parsed {
        Ok(cli) => cli.run(),
        // Help, the version, or a wrong argument, in clap's words and with its exit code, 0 or 2.
        Err(said) => {
            print::printed(if ranks::writes() { said.print() } else { Ok(()) });
            match print::all_printed() {
                Ok(()) => return ExitCode::from(u8::try_from(said.exit_code()).unwrap_or(2)),
                // Where a message on standard error is lost, the code of the error itself stands.
                Err(_) if said.use_stderr() => return ExitCode::from(2),
                Err(error) => Err(error),
            }
        }
    };
    let Err(error) = outcome else { return ExitCode::SUCCESS };
    // Nobody may read along: the exit code stands. Of another rank's error that one speaks.
    if !matches!(error, Error::OtherRank { .. }) {
        print::complain(&error);
    }
    ExitCode::from(error.exit_code())
}
