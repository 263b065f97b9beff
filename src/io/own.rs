//! The list of the files that this program has made in the folder of a run: the file `.dgmpm` there, a name a line, relative to
//! the folder. A name comes onto the list before the file appears, so that a killed run leaves no file without its name.
//! What is not on the list belongs to the user: it is neither removed nor replaced.
//!
//! A folder without the file is no folder of a run; nothing is noted there.

use crate::error::{Error, Result};
use std::collections::BTreeSet;
use std::fs::OpenOptions;
use std::io::Write;
use std::path::{Path, PathBuf};

/// The name of the list.
pub const LIST: &str = ".dgmpm";
/// Folders that a file of a run may lie below that of the run.
const DEPTH: usize = 2;

/// Puts a file that is about to be made on the list of the run in whose folder it lies.
///
/// # Errors
/// A list that cannot be written.
pub fn note(target: &Path) -> Result<()> {
    // A file that is there has its name on the list, or is the user's.
    if target.symlink_metadata().is_ok() {
        return Ok(());
    }
    let Some((root, name)) = place(target) else { return Ok(()) };
    let list = root.join(LIST);
    let mut file = OpenOptions::new().append(true).open(&list).map_err(|why| Error::output(&list, why))?;
    // One write: two programs that append do not mix their lines.
    file.write_all(format!("{name}\n").as_bytes()).map_err(|why| Error::output(&list, why))
}

/// Whether a file stands in the folder of a run and is the user's.
pub fn is_foreign(target: &Path) -> bool {
    let is_there = target.symlink_metadata().is_ok();
    is_there && place(target).is_some_and(|(root, name)| !read(&root).contains(&name))
}

/// The names on the list of a folder; none where it has no list.
pub fn read(root: &Path) -> BTreeSet<String> {
    let text = std::fs::read(root.join(LIST)).unwrap_or_default();
    let text = String::from_utf8_lossy(&text).into_owned();
    // A line without its end was cut off by a kill: its file has not been made.
    let whole = text.rfind('\n').map_or("", |end| &text[..end]);
    whole.lines().filter(|line| is_plain(line)).map(str::to_owned).collect()
}

/// Writes the names of the files that are still there in place of the list.
///
/// # Errors
/// A list that cannot be written.
pub fn shorten(root: &Path) -> Result<()> {
    let names: Vec<String> =
        read(root).into_iter().filter(|name| root.join(name).symlink_metadata().is_ok()).map(|n| n + "\n").collect();
    let list = root.join(LIST);
    // In place: the file bears the lock of the run.
    std::fs::write(&list, names.concat()).map_err(|why| Error::output(&list, why))
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
    fn a_list_names_no_file_outside_of_its_folder() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(LIST), "../a\n/etc/passwd\nx/../../y\na.csv\n.dgmpm\ncut").unwrap();
        assert_eq!(read(folder.path()).into_iter().collect::<Vec<_>>(), ["a.csv"]);
    }
}
