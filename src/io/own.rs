//! The list of the files that this program has made in the folder of a run: the file `.dgmpm` there, a name a line, relative to
//! the folder. A name comes onto the list before the file appears, so that a killed run leaves no file without its name.
//! What is not on the list belongs to the user: it is neither removed nor replaced.
//!
//! A file has its blake3 hash behind its name and a tab, once it is complete; one with a seal the hash that is in the seal. The last line
//! of a name counts: one without a hash says that the file is being written, and one with a tab and nothing behind it that it was not made.
//!
//! A folder without the list is no folder of a run; nothing is noted there.

use crate::error::{Error, Result};
use std::collections::{BTreeMap, BTreeSet};
use std::fs::OpenOptions;
use std::io::{Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

/// The name of the list.
pub const LIST: &str = ".dgmpm";
/// Folders that a file of a run may lie below that of the run.
const DEPTH: usize = 2;
/// Between a name and the hash of its file.
const TAB: char = '\t';

/// Puts a file that is about to be made on the list of the run in whose folder it lies.
///
/// # Errors
/// A list that cannot be written.
pub fn note(target: &Path) -> Result<()> {
    // A file that is there has its name on the list, or is the user's.
    if target.symlink_metadata().is_ok() { Ok(()) } else { begin(target) }
}

/// Says that a file is being written: a hash that the list has of it no longer counts.
///
/// # Errors
/// A list that cannot be written.
pub fn begin(target: &Path) -> Result<()> {
    place(target).map_or(Ok(()), |(root, name)| append(&root, &format!("{name}\n")))
}

/// Says that a file is complete, and has this hash, or this one in its seal.
///
/// # Errors
/// A list that cannot be written.
pub fn finish(target: &Path, hash: &blake3::Hash) -> Result<()> {
    place(target).map_or(Ok(()), |(root, name)| append(&root, &format!("{name}{TAB}{}\n", hash.to_hex())))
}

/// Says that a file that was begun has not been made, and is not there. Where that cannot be written, its name stays.
pub fn give_up(target: &Path) {
    if let Some((root, name)) = place(target).filter(|_| target.symlink_metadata().is_err()) {
        let _ = append(&root, &format!("{name}{TAB}\n"));
    }
}

fn append(root: &Path, line: &str) -> Result<()> {
    let list = root.join(LIST);
    let write = || {
        let mut file = OpenOptions::new().read(true).append(true).open(&list)?;
        let length = file.metadata()?.len();
        let mut last = [b'\n'];
        if length > 0 {
            file.seek(SeekFrom::End(-1))?;
            file.read_exact(&mut last)?;
        }
        // What a kill has left of a line is closed, and is then no name of a file.
        let start = if last == [b'\n'] { "" } else { "\n" };
        // One write: two programs that append do not mix their lines.
        let written = file.write_all(format!("{start}{line}").as_bytes());
        // Cutting takes no space: it works on a full disk, too.
        written.inspect_err(|_| drop(file.set_len(length)))
    };
    write().map_err(|why| Error::output(&list, why))
}

/// Whether a file stands in the folder of a run and is the user's.
pub fn is_foreign(target: &Path) -> bool {
    let is_there = target.symlink_metadata().is_ok();
    is_there && place(target).is_some_and(|(root, name)| !read(&root).contains(&name))
}

/// The names on the list of a folder; none where it has no list.
pub fn read(root: &Path) -> BTreeSet<String> {
    hashes(root).into_keys().collect()
}

/// The names on the list of a folder, each with the hash of its file in hexadecimal digits: none of files that are being written.
pub fn hashes(root: &Path) -> BTreeMap<String, Option<String>> {
    let text = std::fs::read(root.join(LIST)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text).into_owned();
    // A line without its end was cut off by a kill: its file has not been made.
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    let entry = |line: &str| match line.split_once(TAB) {
        Some((name, hash)) => (name.to_owned(), Some(hash.to_owned())),
        None => (line.to_owned(), None),
    };
    let mut all: BTreeMap<_, _> = whole.lines().map(entry).filter(|(name, _)| is_plain(name)).collect();
    all.retain(|_, hash| hash.as_deref() != Some(""));
    all
}

/// Writes the names of the files that are still there in place of the list.
///
/// # Errors
/// A list that cannot be written.
pub fn shorten(root: &Path) -> Result<()> {
    let mut text = String::new();
    for (name, hash) in hashes(root).into_iter().filter(|(name, _)| root.join(name).symlink_metadata().is_ok()) {
        text += &hash.map_or_else(|| format!("{name}\n"), |hash| format!("{name}{TAB}{hash}\n"));
    }
    let list = root.join(LIST);
    // In place, since the file bears the lock of the run; and cut afterwards, so that a kill in between loses no name.
    let write = || {
        let mut file = OpenOptions::new().write(true).open(&list)?;
        file.write_all(text.as_bytes())?;
        file.set_len(text.len() as u64)
    };
    write().map_err(|why| Error::output(&list, why))
}

/// The folder of the run, and the name of the file there.
fn place(target: &Path) -> Option<(PathBuf, String)> {
    let mut folder = target.parent()?.to_owned();
    let mut name = PathBuf::from(target.file_name()?);
    for _ in 0..DEPTH {
        if folder.join(LIST).is_file() {
            return Some((folder.clone(), name.to_str()?.to_owned()));
        }
        name = Path::new(folder.file_name()?).join(name);
        folder = folder.parent()?.to_owned();
    }
    None
}

/// Whether a line can be the name of a file of a run: not one outside of its folder, whatever was written into the list.
fn is_plain(line: &str) -> bool {
    let path = Path::new(line);
    let is_name = |part: std::path::Component| matches!(part, std::path::Component::Normal(_));
    line != LIST && path.components().count() <= DEPTH && path.components().all(is_name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_of_the_folder_and_of_its_folders_are_noted_once_and_others_are_not() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        let all = ["ledger.csv", "snapshots/000001.h5"];
        all.iter().for_each(|name| note(&root.join(name)).unwrap());
        assert!(read(root).is_empty(), "without a list nothing is noted");
        std::fs::write(root.join(LIST), "").unwrap();
        for name in all {
            note(&root.join(name)).unwrap();
        }
        std::fs::create_dir(root.join("snapshots")).unwrap();
        std::fs::write(root.join("ledger.csv"), "").unwrap();
        std::fs::write(root.join("own.csv"), "").unwrap();
        assert!(is_foreign(&root.join("own.csv")) && !is_foreign(&root.join("ledger.csv")));
        note(&root.join("own.csv")).unwrap();
        note(&root.join("a/b/c.csv")).unwrap();
        assert_eq!(read(root).into_iter().collect::<Vec<_>>(), all);
        shorten(root).unwrap();
        assert_eq!(read(root).into_iter().collect::<Vec<_>>(), ["ledger.csv"]);
    }

    #[test]
    fn the_last_line_of_a_file_says_whether_it_is_complete_and_a_torn_line_is_no_name() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path();
        // The line of a run of an earlier version, and one that a kill has torn.
        std::fs::write(root.join(LIST), "old.csv\nled").unwrap();
        let table = root.join("ledger.csv");
        note(&table).unwrap();
        finish(&table, &blake3::hash(b"a")).unwrap();
        let digits = blake3::hash(b"a").to_hex().to_string();
        let known = |name: &str| hashes(root).get(name).cloned();
        assert_eq!([known("old.csv"), known("ledger.csv")], [Some(None), Some(Some(digits))]);
        std::fs::write(&table, "").unwrap();
        shorten(root).unwrap();
        assert!(known("ledger.csv").is_some_and(|hash| hash.is_some()) && known("old.csv").is_none());
        begin(&table).unwrap();
        assert_eq!(known("ledger.csv"), Some(None), "it is written again");
        give_up(&table);
        assert_eq!(known("ledger.csv"), Some(None), "it is there");
        std::fs::remove_file(&table).unwrap();
        give_up(&table);
        assert_eq!(known("ledger.csv"), None);
    }

    #[test]
    fn a_list_names_no_file_outside_of_its_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(LIST), "../a\n/etc/passwd\nx/../../y\na.csv\n.dgmpm\ncut").unwrap();
        assert_eq!(read(folder.path()).into_iter().collect::<Vec<_>>(), ["a.csv"]);
    }
}
