//! What is said in JSON: one object a line, on standard output.

use super::manner::{Manner, manner};
use super::out::{aligned, write};
use crate::format::Row;
use serde_json::{Value, json};

/// Prints what a command was asked for: a table, or one object of JSON.
pub fn result(rows: &[Row], object: &Value) {
    if manner() == Manner::Json { write(&object.to_string()) } else { aligned(rows) }
}

/// Prints an object of JSON on one line, with the name of what has happened.
pub fn event(name: &str, mut of: Value) {
    of["event"] = json!(name);
    write(&of.to_string());
}

/// Prints a line, with what stands before it in words, unless nothing but answers is wanted.
pub fn line(name: &str, text: &str, before: &str) {
    match manner() {
        Manner::Plain => write(&format!("{before}{text}")),
        Manner::Quiet => {}
        Manner::Json => event(name, json!({ "text": text })),
    }
}
