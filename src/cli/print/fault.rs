//! Why a command fails.

use super::json::event;
use super::manner::{self, Manner, manner};
use super::out;
use super::silent::silence;
use crate::cli::ranks;
use crate::error::Error;

/// Prints the message of an error on standard error, also where this process is to be silent: another rank than 0 gives its number.
pub fn complain(error: &Error) {
    silence(false);
    match manner() {
        Manner::Json => event("error", manner::of_error(error)),
        _ => out::complain("error", manner::RED, &format!("{}{error}", of_rank())),
    }
}

fn of_rank() -> String {
    match ranks::number() {
        0 => String::new(),
        rank => format!("rank {rank}: "),
    }
}
