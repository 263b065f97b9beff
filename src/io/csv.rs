//! Tables as CSV, written row by row during a run. Each number is the shortest text that gives the same bits when it is
//! read.

use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};

use crate::error::{Error, Result};

/// A table that is being written: a header, then rows of numbers.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    columns: usize,
    file: BufWriter<File>,
}

impl Table {
    /// Starts a table with these columns. It replaces a file of that name.
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self> {
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|e| Error::output(folder, e))?;
        }
        if let Some(name) = columns.iter().find(|c| c.contains([',', '"', '\n', '\r'])) {
            return Err(Error::output(path, format!("`{name}` cannot be the name of a column")));
        }
        let file = File::create(path).map_err(|e| Error::output(path, e))?;
        let mut table = Self { path: path.to_owned(), columns: columns.len(), file: BufWriter::new(file) };
        table.line(columns.join(","))?;
        Ok(table)
    }

    /// Adds a row.
    pub fn push(&mut self, row: &[f64]) -> Result<()> {
        if row.len() != self.columns {
            let what = format!("a row has {} values for {} columns", row.len(), self.columns);
            return Err(Error::output(&self.path, what));
        }
        let texts: Vec<String> = row.iter().map(|v| format!("{v:e}")).collect();
        self.line(texts.join(","))
    }

    /// Writes all rows so far to the disk.
    pub fn flush(&mut self) -> Result<()> {
        self.file.flush().map_err(|e| Error::output(&self.path, e))
    }

    fn line(&mut self, text: String) -> Result<()> {
        writeln!(self.file, "{text}").map_err(|e| Error::output(&self.path, e))
    }
}
