//! Tables as CSV, written row by row during a run. Each number is the shortest text that gives the same bits when it is
//! read. A table always ends with a whole row: what a full disk or a kill leaves of a row is cut off.

use std::fs::{File, OpenOptions};
use std::io::{Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use super::own;
use crate::error::{Error, Result};
use crate::words::{Saved, Words};

/// Bytes of rows that are kept in memory between two calls of [`Table::flush`].
const BUFFER: usize = 1 << 20;

/// A table that is being written: a header, then rows of numbers.
#[derive(Debug)]
pub struct Table {
    path: PathBuf,
    columns: usize,
    header: String,
    file: File,
    /// Bytes of the file, which end with a whole row. None: the file may hold the rows of a run that is resumed.
    length: Option<u64>,
    /// The hash of these bytes, so that a table that was changed in the meantime is not gone on with.
    hash: blake3::Hasher,
    /// Rows that are not in the file yet.
    rows: String,
}

impl Table {
    /// Starts a table with these columns. The first row replaces what a file of that name holds, unless [`Table::restore`] says what of
    /// it stays.
    ///
    /// # Errors
    /// A file that cannot be written, or that stands in the folder of a run and is the user's.
    pub fn create(path: &Path, columns: &[&str]) -> Result<Self> {
        if let Some(folder) = path.parent().filter(|f| !f.as_os_str().is_empty()) {
            std::fs::create_dir_all(folder).map_err(|e| Error::output(folder, e))?;
        }
        if let Some(name) = columns.iter().find(|c| c.contains([',', '"', '\n', '\r'])) {
            return Err(Error::output(path, format!("`{name}` cannot be the name of a column")));
        }
        if own::is_foreign(path) {
            return Err(Error::output(path, "there is a file of this name, which dgmpm has not made"));
        }
        own::note(path)?;
        let fail = |e: std::io::Error| Error::output(path, e);
        let file = OpenOptions::new().create(true).write(true).truncate(false).open(path).map_err(fail)?;
        let empty = file.metadata().map_err(fail)?.len() == 0;
        let header = columns.join(",") + "\n";
        let (path, rows, hash) = (path.to_owned(), String::new(), blake3::Hasher::new());
        let mut table = Self { path, columns: columns.len(), header, file, length: None, hash, rows };
        if empty {
            table.flush()?;
        }
        Ok(table)
    }

    /// Adds a row.
    pub fn push(&mut self, row: &[f64]) -> Result<()> {
        if row.len() != self.columns {
            let what = format!("a row has {} values for {} columns", row.len(), self.columns);
            return Err(Error::output(&self.path, what));
        }
        let texts: Vec<String> = row.iter().map(|v| format!("{v:e}")).collect();
        self.rows += &texts.join(",");
        self.rows.push('\n');
        if self.rows.len() > BUFFER { self.flush() } else { Ok(()) }
    }

    /// Writes all rows so far to the file: whole, or none of those that are left.
    ///
    /// # Errors
    /// A file that cannot be written, or that was removed.
    pub fn flush(&mut self) -> Result<()> {
        let written = self.write_rows();
        written.map_err(|e| Error::output(&self.path, e))?;
        match removed(&self.file) {
            true => Err(Error::output(&self.path, "the file was removed during the run")),
            false => Ok(()),
        }
    }

    fn write_rows(&mut self) -> std::io::Result<()> {
        let length = match self.length {
            Some(length) => length,
            None => {
                own::begin(&self.path).map_err(std::io::Error::other)?;
                self.file.set_len(0)?;
                self.rows.insert_str(0, &self.header);
                0
            }
        };
        self.file.seek(SeekFrom::Start(length))?;
        let written = self.file.write_all(self.rows.as_bytes());
        if written.is_err() {
            // Cutting takes no space: it works on a full disk, too.
            let _ = self.file.set_len(length);
        } else {
            self.length = Some(length + self.rows.len() as u64);
            self.hash.update(self.rows.as_bytes());
            self.rows.clear();
        }
        written
    }

    /// Saves how far the table goes, once the disk has all rows.
    ///
    /// # Errors
    /// A disk that does not take them.
    pub fn save(&mut self, to: &mut Words) -> Result<()> {
        if !self.rows.is_empty() {
            self.flush()?;
        }
        self.file.sync_data().map_err(|e| Error::output(&self.path, e))?;
        to.count(self.length.unwrap_or(0) as usize).text(self.hash.finalize().to_hex().as_str());
        Ok(())
    }

    /// Goes on behind the last row that was saved; what came after it is cut off.
    ///
    /// # Errors
    /// A file that has lost or changed rows, or that has other columns.
    pub fn restore(&mut self, from: &mut Saved) -> Result<()> {
        let (length, digits) = (from.count()? as u64, from.text()?);
        let fail = |e: std::io::Error| Error::output(&self.path, e);
        let text = std::fs::read(&self.path).map_err(fail)?;
        let kept = usize::try_from(length).ok().and_then(|length| text.get(..length));
        let columns = self.columns;
        let fits = |kept: &&[u8]| {
            let header = kept.split(|c| *c == b'\n').next().unwrap_or_default();
            header.iter().filter(|c| **c == b',').count() + 1 == columns && kept.ends_with(b"\n")
        };
        let hash = kept.filter(fits).map(|kept| blake3::Hasher::new().update(kept).clone());
        let Some(hash) = hash.filter(|hash| hash.finalize().to_hex().as_str() == digits) else {
            let what = format!("{} has lost or changed rows that the run had written", self.path.display());
            return Err(Error::input(what, "put the file back, or run the scene again with --force"));
        };
        own::begin(&self.path)?;
        self.hash = hash;
        self.file.set_len(length).map_err(fail)?;
        self.length = Some(length);
        Ok(())
    }
}

impl Drop for Table {
    /// A table that is complete has its hash on the list of the folder of the run. Where that cannot be written, there is none.
    fn drop(&mut self) {
        if self.length.is_some() && self.rows.is_empty() && !removed(&self.file) {
            let _ = own::finish(&self.path, &self.hash.finalize());
        }
    }
}

/// Whether a file has no name any more.
#[cfg(unix)]
fn removed(file: &File) -> bool {
    use std::os::unix::fs::MetadataExt;
    file.metadata().is_ok_and(|about| about.is_file() && about.nlink() == 0)
}

/// Systems that do not remove open files.
#[cfg(not(unix))]
fn removed(_: &File) -> bool {
    false
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(path: &Path) -> Table {
        Table::create(path, &["t", "x"]).unwrap()
    }

    fn add(table: &mut Table, rows: std::ops::Range<usize>) {
        for k in rows {
            table.push(&[k as f64, 0.5]).unwrap();
            table.flush().unwrap();
        }
    }

    #[test]
    fn a_table_goes_on_behind_its_last_saved_row_and_a_new_one_replaces_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        let mut words = Words::default();
        let mut first = table(&path);
        add(&mut first, 0..2);
        first.save(&mut words).unwrap();
        add(&mut first, 2..4);
        drop(first);
        // A kill in the middle of a row.
        let torn = std::fs::read_to_string(&path).unwrap() + "4e0,5e";
        std::fs::write(&path, torn).unwrap();
        let mut second = table(&path);
        second.restore(&mut words.saved()).unwrap();
        add(&mut second, 2..3);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "t,x\n0e0,5e-1\n1e0,5e-1\n2e0,5e-1\n");
        add(&mut table(&path), 7..8);
        assert_eq!(std::fs::read_to_string(&path).unwrap(), "t,x\n7e0,5e-1\n");
        let lost = table(&path).restore(&mut words.saved()).unwrap_err();
        assert!(lost.to_string().contains("has lost or changed rows"), "{lost}");
    }

    #[test]
    fn a_removed_table_is_an_error_at_the_next_row() {
        let folder = tempfile::tempdir().unwrap();
        let mut table = table(&folder.path().join("a.csv"));
        std::fs::remove_file(folder.path().join("a.csv")).unwrap();
        table.push(&[0.0, 0.0]).unwrap();
        assert!(table.flush().unwrap_err().to_string().contains("was removed during the run"));
    }
}
