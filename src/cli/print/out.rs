//! Where words go: standard output, and standard error for what is wrong, with colours on a terminal alone.

use super::silent::is_silent;
use crate::error::{Error, Result};
use crate::format::Row;
use anstyle::Style;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

/// The first reason why standard output could not be written, such as a full device.
static FAULT: Mutex<Option<String>> = Mutex::new(None);

/// Writes a line on standard output.
pub fn write(text: &str) {
    if is_silent() {
        return;
    }
    let mut out = std::io::stdout().lock();
    printed(writeln!(out, "{text}").and_then(|()| out.flush()));
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

/// Writes a line on standard error behind a word, which has a colour on a terminal, unless NO_COLOR says otherwise.
pub fn complain(word: &str, style: Style, text: &str) {
    if is_silent() {
        return;
    }
    let _ = writeln!(anstream::stderr(), "{style}{word}{style:#}: {text}");
}

/// Writes a table of two columns.
pub fn aligned(rows: &[Row]) {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().for_each(|(name, value)| write(&format!("  {name:width$}  {value}")));
}
