//! What commands say. A reader that closes the pipe (`dgmpm run .. | head -1`) neither stops nor breaks a run: results
//! are files, and the exit code says how it went. Any other reason why nothing can be printed is an error at the end.

mod fault;
mod json;
mod manner;
mod out;
mod silent;

pub use fault::complain;
pub use json::{event, result};
pub use manner::{Manner, manner, speak};
pub use out::{all_printed, printed, write};
pub use silent::silence;

use crate::format::Row;
use serde_json::{Map, Value, json};

/// Prints a line on standard output, unless nothing but answers is wanted.
pub fn say(text: impl AsRef<str>) {
    json::line("line", text.as_ref(), "");
}

/// Prints a line on standard output, as a notice: no error, and yet seldom meant.
pub fn note(text: impl AsRef<str>) {
    json::line("note", text.as_ref(), "note: ");
}

/// Prints a line that the command was asked for, also where it is to be quiet.
pub fn answer(text: impl AsRef<str>) {
    match manner() {
        Manner::Json => event("line", json!({ "text": text.as_ref() })),
        _ => write(text.as_ref()),
    }
}

/// Prints a line on standard error, as a warning.
pub fn warn(text: impl AsRef<str>) {
    match manner() {
        Manner::Json => event("warning", json!({ "text": text.as_ref() })),
        _ => out::complain("warning", manner::YELLOW, text.as_ref()),
    }
}

/// Prints a table of two columns.
pub fn table(rows: &[Row]) {
    match manner() {
        Manner::Quiet => {}
        Manner::Json => {
            let all: Map<String, Value> = rows.iter().map(|(name, value)| (name.clone(), json!(value))).collect();
            event("table", json!({ "rows": all }));
        }
        Manner::Plain => out::aligned(rows),
    }
}
