//! Loads over time, from a CSV file.

use super::regular;
use super::seal::{self, Seal};
use crate::error::{Error, Place, Result};
use serde::Serialize;
use std::path::Path;

/// Values at times, linear in between; before the first row that of the first row, behind the last that of the last.
///
/// Two rows of the same time are a jump, and the later one holds from there on.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct LoadTable {
    /// Times of the rows, s, never falling.
    times: Vec<f64>,
    /// Values behind the time, [row][column].
    values: Vec<f64>,
    /// Columns behind the time.
    columns: usize,
}

/// A place in a table, for messages.
struct Reading<'a> {
    path: &'a Path,
    columns: usize,
    unit: &'a str,
}

impl LoadTable {
    /// Reads a file: a header with `t` and so many `columns` more, then a row of numbers a line. The header may say units behind the names, `t [s]` or
    /// `p (Pa)`: they have to be s, and `unit`. Lines that begin with `#` are skipped.
    ///
    /// # Errors
    /// A file that cannot be read; a header or a row that is no such thing, with its line.
    pub fn read(path: &Path, columns: usize, unit: &str) -> Result<Self> {
        let text = regular::text(path, u64::MAX).map_err(|why| {
            Error::at(Place::file(path), format!("the file cannot be read: {why}"), "give a CSV file")
        })?;
        if seal::check_text(text.as_bytes()) == Seal::Broken {
            let what = "the file is damaged: its bytes are not those that were written";
            return Err(Error::at(Place::file(path), what, "if you have changed it, remove its last line"));
        }
        Self::parse(&text, path, columns, unit)
    }

    /// Reads the text of a file, as [`LoadTable::read`]; `path` stands in messages.
    ///
    /// # Errors
    /// As for [`LoadTable::read`].
    pub fn parse(text: &str, path: &Path, columns: usize, unit: &str) -> Result<Self> {
        let reading = Reading { path, columns, unit };
        let lines = text.lines().enumerate().map(|(k, line)| (k + 1, line.trim()));
        let mut lines = lines.filter(|(_, line)| !line.is_empty() && !line.starts_with('#'));
        let (first, header) = lines.next().unwrap_or((1, ""));
        reading.header(first, header)?;
        let mut table = Self { times: vec![], values: vec![], columns };
        for (number, line) in lines {
            let row = reading.row(number, line)?;
            if let Some(before) = table.times.last().filter(|before| row[0] < **before) {
                let what = format!("the time {} comes after {before}", row[0]);
                return Err(reading.wrong(number, 1, what, "times must not fall from row to row"));
            }
            table.times.push(row[0]);
            table.values.extend_from_slice(&row[1..]);
        }
        match table.times.is_empty() {
            true => Err(reading.wrong(first, 1, "the table has no row".to_owned(), "give at least one row of numbers")),
            false => Ok(table),
        }
    }

    /// The value of a column at a time.
    pub fn at(&self, time: f64, column: usize) -> f64 {
        let after = self.times.partition_point(|row| *row <= time);
        let value = |row: usize| self.values[row * self.columns + column];
        if after == 0 || after == self.times.len() {
            return value(after.saturating_sub(1));
        }
        let (before, [from, to]) = (value(after - 1), [self.times[after - 1], self.times[after]]);
        before + (value(after) - before) * ((time - from) / (to - from))
    }

    /// The time of the last row, s.
    pub fn end(&self) -> f64 {
        self.times.last().copied().unwrap_or(f64::NEG_INFINITY)
    }
}

impl Reading<'_> {
    fn header(&self, number: usize, line: &str) -> Result<()> {
        let names: Vec<&str> = line.split(',').map(str::trim).collect();
        let form = self.form();
        if names.len() != 1 + self.columns || !["t", "time"].contains(&split(names[0]).0) {
            return Err(self.wrong(number, 1, format!("`{line}` is no header of a table of loads"), &form));
        }
        let units = std::iter::once("s").chain(std::iter::repeat(self.unit));
        let mut column = 1;
        for (name, unit) in names.into_iter().zip(units) {
            if name.parse::<f64>().is_ok() {
                return Err(self.wrong(number, column, format!("the header has the number {name} as a name"), &form));
            }
            if let Some(given) = split(name).1.filter(|given| *given != unit) {
                let what = format!("the unit of `{}` is {given}", split(name).0);
                return Err(self.wrong(number, column, what, &format!("give the numbers in {unit}")));
            }
            column += name.chars().count() + 1;
        }
        Ok(())
    }

    fn row(&self, number: usize, line: &str) -> Result<Vec<f64>> {
        let texts: Vec<&str> = line.split(',').map(str::trim).collect();
        if texts.len() != 1 + self.columns {
            let what = format!("the row has {} value(s) for {} columns", texts.len(), 1 + self.columns);
            return Err(self.wrong(number, 1, what, &self.form()));
        }
        let mut column = 1;
        let mut row = Vec::with_capacity(texts.len());
        for text in texts {
            let value = text.parse().ok().filter(|value: &f64| value.is_finite());
            let remedy = "give numbers such as 1.5 or -2e8, with commas between them";
            row.push(value.ok_or_else(|| self.wrong(number, column, format!("`{text}` is not a number"), remedy))?);
            column += text.chars().count() + 1;
        }
        Ok(row)
    }

    fn form(&self) -> String {
        let names: Vec<String> = match self.columns {
            1 => vec!["value".to_owned()],
            n => (1..=n).map(|k| format!("value_{k}")).collect(),
        };
        format!("the first line names the columns: t,{}; times are in s, values in {}", names.join(","), self.unit)
    }

    fn wrong(&self, line: usize, column: usize, what: String, remedy: &str) -> Error {
        Error::at(Place::line(self.path, line, column), what, remedy)
    }
}

/// The name and the unit of a column, as in `t [s]` or `p (Pa)`.
fn split(name: &str) -> (&str, Option<&str>) {
    let end = |c| name.strip_suffix(c).and_then(|rest| rest.split_once(if c == ']' { '[' } else { '(' }));
    match end(']').or_else(|| end(')')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (name, None),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(text: &str, columns: usize) -> Result<LoadTable> {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("load.csv");
        std::fs::write(&path, text).unwrap();
        LoadTable::read(&path, columns, "Pa")
    }

    #[test]
    fn a_table_is_linear_between_its_rows_and_constant_outside() {
        let table = read("# from a test\nt [s], a (Pa), b\n0,1,10\n2,3,-10\n", 2).unwrap();
        let at = |t: f64| [table.at(t, 0), table.at(t, 1)];
        assert_eq!(
            [at(-1.0), at(0.0), at(0.5), at(2.0), at(9.0)],
            [[1.0, 10.0], [1.0, 10.0], [1.5, 5.0], [3.0, -10.0], [3.0, -10.0]]
        );
        assert_eq!(table.end(), 2.0);
    }

    #[test]
    fn a_mark_of_the_byte_order_and_line_ends_of_windows_change_nothing() {
        let plain = read("t [s],p [Pa]\n0,1\n2,3\n", 1).unwrap();
        assert_eq!(read("\u{feff}t [s],p [Pa]\r\n0,1\r\n2,3\r\n", 1).unwrap(), plain);
    }

    #[test]
    fn two_rows_of_one_time_are_a_jump() {
        let table = read("t,p\n0,0\n1,4\n1,8\n2,8\n", 1).unwrap();
        assert_eq!([0.5, 1.0, 1.5].map(|t| table.at(t, 0)), [2.0, 8.0, 8.0]);
    }

    #[test]
    fn bad_tables_say_line_and_remedy() {
        for (text, place, what) in [
            ("", ":1:1", "no header"),
            ("0,1\n1,2\n", ":1:1", "no header"),
            ("t,5\n", ":1:3", "the number 5 as a name"),
            ("t [ms],p\n0,1\n", ":1:1", "the unit of `t` is ms"),
            ("t,p [MPa]\n0,1\n", ":1:3", "the unit of `p` is MPa\n  give the numbers in Pa"),
            ("t,p\n", ":1:1", "no row"),
            ("t,p\n0,1\n1\n", ":3:1", "1 value(s) for 2 columns"),
            ("t,p\n0,1\n\n1,x\n", ":4:3", "`x` is not a number"),
            ("t,p\n0,nan\n", ":2:3", "`nan` is not a number"),
            ("t,p\n1,1\n0,2\n", ":3:1", "the time 0 comes after 1"),
        ] {
            let message = read(text, 1).unwrap_err().to_string();
            assert!(message.contains(place) && message.contains(what), "{text:?}: {message}");
        }
    }
}
