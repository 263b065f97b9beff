//! The manner in which commands speak: in words, not more than they must, or in JSON.

use crate::error::Error;
use anstyle::{AnsiColor, Style};
use serde_json::{Value, json};
use std::sync::atomic::{AtomicU8, Ordering};

/// How commands speak.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Manner {
    /// In words, for people.
    Plain,
    /// Warnings, errors, and what a command was asked for.
    Quiet,
    /// One object of JSON a line, all on standard output.
    Json,
}

static MANNER: AtomicU8 = AtomicU8::new(Manner::Plain as u8);

/// The word `warning` on a terminal.
pub const YELLOW: Style = AnsiColor::Yellow.on_default().bold();
/// The word `error` on a terminal.
pub const RED: Style = AnsiColor::Red.on_default().bold();

/// Speaks in a manner from now on.
pub fn speak(manner: Manner) {
    MANNER.store(manner as u8, Ordering::Relaxed);
}

/// The manner of this process.
pub fn manner() -> Manner {
    let now = MANNER.load(Ordering::Relaxed);
    [Manner::Quiet, Manner::Json].into_iter().find(|manner| *manner as u8 == now).unwrap_or(Manner::Plain)
}

/// An error with its exit code; bad input also with its place and with what would be right.
pub fn of_error(error: &Error) -> Value {
    let code = error.exit_code();
    match error {
        Error::Input { what, place, remedy } => {
            let place = place.to_string();
            json!({ "exit_code": code, "what": what, "place": place.trim_end_matches(": "), "remedy": remedy })
        }
        other => json!({ "exit_code": code, "what": other.to_string() }),
    }
}
