//! Rows of tables, and numbers as people say them.

/// A row of a table of two columns: name and value.
pub type Row = (String, String);

/// A row of a table of two columns.
pub fn row(name: impl Into<String>, value: impl Into<String>) -> Row {
    (name.into(), value.into())
}

/// A number of things: `1 step`, `2 steps`.
pub fn count(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
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

/// The same, with milliseconds below one second.
pub fn short_seconds(s: f64) -> String {
    if s < 1.0 { format!("{:.1} ms", 1e3 * s) } else { seconds(s) }
}

/// A word of a command as a shell of Unix takes it: in quotes where it has blanks or other marks.
pub fn shell(word: impl std::fmt::Display) -> String {
    let word = word.to_string();
    let plain = |c: char| c.is_alphanumeric() || "/._-+=:,@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) { word } else { format!("'{}'", word.replace('\'', r"'\''")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_of_commands_are_quoted_where_a_shell_would_take_them_apart() {
        let found = ["runs/a-1.toml", "runs/my plate.toml", "it's", "a$b", ""].map(shell);
        assert_eq!(found, ["runs/a-1.toml", "'runs/my plate.toml'", r"'it'\''s'", "'a$b'", "''"]);
    }

    #[test]
    fn one_thing_is_singular() {
        assert_eq!([0, 1, 2].map(|n| count(n, "step")), ["0 steps", "1 step", "2 steps"]);
    }
}
