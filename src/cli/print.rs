//! What commands say on standard output; a reader that closes the pipe ends the program quietly.

use std::io::{ErrorKind, Write};

/// Prints a line.
pub fn say(text: impl AsRef<str>) {
    let mut out = std::io::stdout().lock();
    if let Err(why) = writeln!(out, "{}", text.as_ref()).and_then(|()| out.flush())
        && why.kind() == ErrorKind::BrokenPipe
    {
        std::process::exit(0);
    }
}

/// Prints a table of two columns.
pub fn table(rows: &[(String, String)]) {
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    rows.iter().for_each(|(name, value)| say(format!("  {name:width$}  {value}")));
}

/// A row of [`table`].
pub fn row(name: impl Into<String>, value: impl Into<String>) -> (String, String) {
    (name.into(), value.into())
}

/// Bytes as MiB.
pub fn mebibytes(bytes: usize) -> String {
    format!("{:.1} MiB", bytes as f64 / (1024.0 * 1024.0))
}

/// Seconds, as people say them.
pub fn seconds(s: f64) -> String {
    match s {
        s if s < 120.0 => format!("{s:.1} s"),
        s if s < 7200.0 => format!("{:.1} min", s / 60.0),
        s => format!("{:.1} h", s / 3600.0),
    }
}
