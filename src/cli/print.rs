//! What commands say. A reader that closes the pipe (`dgmpm run .. | head -1`) neither stops nor breaks a run: results
//! are files, and the exit code says how it went. Any other reason why nothing can be printed is an error at the end.

use crate::error::{Error, Result};
use crate::format::Row;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// The first reason why standard output could not be written, such as a full device.
static FAULT: Mutex<Option<String>> = Mutex::new(None);

/// Prints a line on standard output.
pub fn say(text: impl AsRef<str>) {
    let mut out = std::io::stdout().lock();
    printed(writeln!(out, "{}", text.as_ref()).and_then(|()| out.flush()));
}

/// Prints a line on standard output, as a notice: no error, and yet seldom meant.
pub fn note(text: impl AsRef<str>) {
    say(format!("note: {}", text.as_ref()));
}

/// Takes notice of what became of a print; a closed pipe is no fault.
pub fn printed(outcome: std::io::Result<()>) {
    if let Err(why) = outcome
        && why.kind() != ErrorKind::BrokenPipe
    {
        FAULT.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_with(|| why.to_string());
    }
}

/// Whether all that was said since the last call could be printed.
///
/// # Errors
/// The system's reason where it could not (exit code 5).
pub fn all_printed() -> Result<()> {
    match FAULT.lock().unwrap_or_else(PoisonError::into_inner).take() {
        Some(why) => Err(Error::Output { path: "standard output".to_owned(), why }),
        None => Ok(()),
    }
}

/// Prints a line on standard error, as a warning.
pub fn warn(text: impl AsRef<str>) {
    let _ = writeln!(std::io::stderr(), "warning: {}", text.as_ref());
}

/// Prints the message of an error on standard error.
pub fn complain(error: &Error) {
    let _ = writeln!(std::io::stderr(), "error: {error}");
}

/// Prints a table of two columns.
pub fn table(rows: &[Row]) {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().for_each(|(name, value)| say(format!("  {name:width$}  {value}")));
}
