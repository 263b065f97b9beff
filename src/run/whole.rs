//! Whether the files of a run are those that were written: each by its own seal, or by its hash on the list of the folder.

use super::Folder;
use crate::error::{Error, Result};
use crate::io::seal::{self, Seal};
use crate::io::{checkpoint, own};
use serde_json::Value;
use std::path::Path;

/// What a look at the files of a run has found.
#[derive(Debug, Default)]
pub struct Whole {
    /// Files whose seal agrees with their bytes.
    pub sealed: usize,
    /// Files whose hash on the list agrees with their bytes.
    pub hashed: usize,
    /// Files without a seal and without a hash, of a run that was killed or of an earlier version; tables among them have whole rows.
    pub open: Vec<String>,
    /// Files that a run that was killed or failed has begun and not made.
    pub unmade: Vec<String>,
    /// What is wrong, a line each with the name of the file.
    pub faults: Vec<String>,
    /// What `summary.json` says; null where it is not there.
    pub summary: Value,
    /// The names of the checkpoints that the run has kept.
    checkpoints: Vec<String>,
}

impl Whole {
    /// Looks at all files that the list of a folder names.
    ///
    /// # Errors
    /// A folder without a list; one that a run is writing into.
    pub fn look(folder: &Folder) -> Result<Self> {
        let root = folder.root.display();
        if !folder.scene().is_file() || !folder.has_list() {
            let missing = if folder.scene().is_file() { own::LIST } else { "scene.toml" };
            let what = format!("{root} is not the folder of a run of this version: it holds no {missing}");
            return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
        }
        if folder.is_taken() {
            return Err(Error::input(format!("a run is writing into {root}"), "wait for its end"));
        }
        let text = std::fs::read_to_string(folder.summary()).unwrap_or_default();
        let mut out = Self { summary: serde_json::from_str(&text).unwrap_or(Value::Null), ..Self::default() };
        let list = own::hashes(&folder.root);
        out.checkpoints = checkpoint::kept(list.keys().map(String::as_str));
        for (name, hash) in &list {
            out.file(folder, name, hash.as_deref());
        }
        let needed =
            [("scene.toml", true), ("mesh.h5", true), ("cloud.h5", true), ("ledger.csv", folder.summary().exists())];
        for (name, _) in needed.into_iter().filter(|(name, is_needed)| *is_needed && !list.contains_key(*name)) {
            out.faults.push(format!("{name} is not on the list of the folder"));
        }
        out.ends_as_its_summary_says(folder);
        Ok(out)
    }

    /// Looks at one file.
    fn file(&mut self, folder: &Folder, name: &str, hash: Option<&str>) {
        let path = folder.root.join(name);
        // A pipe would be read for ever.
        if path.exists() && !path.is_file() {
            return self.faults.push(format!("{name} is no file"));
        }
        let bytes = match std::fs::read(&path) {
            Ok(bytes) => bytes,
            Err(_) if !path.exists() => {
                // The run itself removes all but its last checkpoints; a run that was killed or found no space has not made all that it began.
                let ended = ["done", "interrupted"].iter().any(|status| self.summary["status"] == *status);
                match name.starts_with("checkpoints/") {
                    true if self.checkpoints.iter().any(|kept| kept == name) && (ended || hash.is_some()) => {
                        self.faults.push(format!("{name} is missing: `dgmpm resume` could not go on from it"));
                    }
                    true => {}
                    false if ended || hash.is_some() => self.faults.push(format!("{name} is missing")),
                    false => self.unmade.push(name.to_owned()),
                }
                return;
            }
            Err(why) => return self.faults.push(format!("{name} cannot be read: {why}")),
        };
        let is_h5 = name.ends_with(".h5");
        let seal = if is_h5 { seal::check(&path).unwrap_or(Seal::None) } else { seal::check_text(&bytes) };
        match (seal, hash) {
            (Seal::Whole, Some(hash)) if !holds(&bytes, hash) => self.faults.push(other(name)),
            (Seal::Whole, _) => self.sealed += 1,
            (Seal::Broken, _) => self.faults.push(damaged(name)),
            (Seal::None, Some(hash)) if blake3::hash(&bytes).to_hex().as_str() == hash => self.hashed += 1,
            (Seal::None, Some(_)) => self.faults.push(damaged(name)),
            (Seal::None, None) if is_sealed(name) => {
                self.faults.push(format!("{name} has no seal: it was cut off, or someone has changed it"));
            }
            (Seal::None, None) => match torn_row(&bytes).filter(|_| name.ends_with(".csv")) {
                None => self.open.push(name.to_owned()),
                Some(row) => self.faults.push(format!("{name} has a row that is not whole, line {row}")),
            },
        }
    }

    /// Whether a run that is done has its last step in the ledger.
    fn ends_as_its_summary_says(&mut self, folder: &Folder) {
        let (status, end) = (self.summary["status"].as_str(), self.summary["end_time"].as_f64());
        let last = last_time(&folder.ledger());
        if status == Some("done") && end != last {
            let words = |time: Option<f64>| time.map_or_else(|| "no time".to_owned(), |time| format!("{time:e} s"));
            let what = format!("ledger.csv ends at {}, and summary.json says {}", words(last), words(end));
            self.faults.push(what);
        }
    }
}

/// Whether a whole file has this hash in its seal.
fn holds(bytes: &[u8], hash: &str) -> bool {
    seal::hash_in(bytes).is_some_and(|own| own.to_hex().as_str() == hash)
}

fn other(name: &str) -> String {
    format!("{name} is whole, but another file than the one that was written under this name")
}

fn damaged(name: &str) -> String {
    format!("{name} is damaged: its bytes are not those that were written")
}

/// Whether the program writes files of this name with a seal.
fn is_sealed(name: &str) -> bool {
    let has_ending = [".h5", ".vtu", ".toml", ".geo"].iter().any(|ending| name.ends_with(ending));
    has_ending || name.starts_with("boundary_")
}

/// The line of the first row of a table that is not whole: of another number of columns than the header, or without its end.
fn torn_row(bytes: &[u8]) -> Option<usize> {
    let text = String::from_utf8_lossy(bytes);
    let columns = |line: &str| line.split(',').count();
    let wanted = columns(text.lines().next().unwrap_or_default());
    let is_number = |text: &str| text.parse::<f64>().is_ok();
    let torn = |line: &str| columns(line) != wanted || !line.split(',').all(is_number);
    let found = text.lines().skip(1).position(torn).map(|row| row + 2);
    found.or_else(|| (!text.is_empty() && !text.ends_with('\n')).then(|| text.lines().count()))
}

/// The time of the last row of a ledger, s.
fn last_time(ledger: &Path) -> Option<f64> {
    let text = std::fs::read_to_string(ledger).ok()?;
    text.lines().last()?.split(',').nth(1)?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_that_is_torn_or_no_row_is_found() {
        assert_eq!(torn_row(b"t,x\n0e0,1e0\n1e0,2e0\n"), None);
        assert_eq!(torn_row(b"t,x\n0e0,1e0\n1e0\n"), Some(3));
        assert_eq!(torn_row(b"t,x\n0e0,1e0\n1e0,2e"), Some(3));
        assert_eq!(torn_row(b"t,x\n0e0,1e0\n1e0,2e0"), Some(3), "the last row has no end");
        assert_eq!(torn_row(b"t,x\n0a0,1e0\n"), Some(2));
    }
}
