//! Files that appear under their name only when they are whole.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use super::own;
use super::seal::{self, Seal};
use crate::error::{Error, Result};

/// A file under a temporary name in the folder of its target. [`Pending::commit`] renames it to the target; without a
/// commit it is removed when it is dropped.
#[derive(Debug)]
pub struct Pending {
    target: PathBuf,
    temporary: PathBuf,
}

impl Pending {
    /// Reserves a temporary name in the folder of `target`, and makes that folder if it does not exist.
    pub fn new(target: &Path) -> Result<Self> {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let name = target.file_name().ok_or_else(|| Error::output(target, "this is not the name of a file"))?;
        if target.is_dir() {
            return Err(Error::output(target, "a folder of this name exists"));
        }
        // The new file replaces the old one. A device must not be replaced by a file.
        if target.exists() && !target.is_file() {
            return Err(Error::output(target, "it is no file but a device, a pipe or a socket"));
        }
        if let Some(folder) = target.parent().filter(|f| !f.as_os_str().is_empty()) {
            fs::create_dir_all(folder).map_err(|e| Error::output(folder, e))?;
        }
        own::note(target)?;
        let mut part = name.to_owned();
        part.push(format!(".{}-{}.part", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed)));
        Ok(Self { target: target.to_owned(), temporary: target.with_file_name(part) })
    }

    /// The temporary path: write here.
    pub fn path(&self) -> &Path {
        &self.temporary
    }

    /// The path that the file gets by the commit.
    pub fn target(&self) -> &Path {
        &self.target
    }

    /// Renames the file to its target and replaces a file of that name. The hash in its seal, if it has one, goes to the list of the
    /// folder of a run, so that another whole file under this name is told from it.
    pub fn commit(self) -> Result<()> {
        let Some(hash) = seal::hash_of(&self.temporary) else {
            return fs::rename(&self.temporary, &self.target).map_err(|e| Error::output(&self.target, e));
        };
        // A kill between the two leaves a file that is whole by its seal, and no hash of the file that was there before.
        if self.target.exists() {
            own::begin(&self.target)?;
        }
        fs::rename(&self.temporary, &self.target).map_err(|e| Error::output(&self.target, e))?;
        // The file is whole by its seal: a list that has no space is no loss of it.
        let _ = own::finish(&self.target, &hash);
        Ok(())
    }

    /// The same, once the disk has the bytes: after a power cut there is the old file or the new one.
    pub fn commit_to_disk(self) -> Result<()> {
        let fail = |e: std::io::Error| Error::output(&self.target, e);
        fs::File::open(&self.temporary).and_then(|file| file.sync_all()).map_err(fail)?;
        let folder = self.target.parent().filter(|f| !f.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        self.commit()?;
        // The name, too. A system that cannot sync folders does so by itself.
        let _ = fs::File::open(folder).and_then(|folder| folder.sync_all());
        Ok(())
    }
}

/// Whether a file name is that of a file that was being written when its program was killed: `name.pid-count.part`; its target.
pub fn target_of_part(name: &str) -> Option<&str> {
    let (target, number) = name.strip_suffix(".part")?.rsplit_once('.')?;
    let (process, count) = number.split_once('-')?;
    let is_number = |text: &str| !text.is_empty() && text.bytes().all(|c| c.is_ascii_digit());
    (is_number(process) && is_number(count)).then_some(target)
}

/// Refuses a folder that is no longer there: a run does not make its folder anew once it was removed.
///
/// # Errors
/// An output that cannot be written.
pub fn check_folder(folder: &Path) -> Result<()> {
    match folder.is_dir() {
        true => Ok(()),
        false => Err(Error::output(folder, "the folder was removed during the run")),
    }
}

impl Drop for Pending {
    fn drop(&mut self) {
        // After a commit there is nothing to remove; before it, a file that cannot be removed does no harm.
        let _ = fs::remove_file(&self.temporary);
        own::give_up(&self.target);
    }
}

/// Writes a whole file without a seal: all of it, or nothing. Its hash goes to the list of the folder of a run.
pub fn write_bytes(path: &Path, bytes: &[u8]) -> Result<()> {
    let pending = Pending::new(path)?;
    fs::write(pending.path(), bytes).map_err(|e| Error::output(path, e))?;
    own::begin(path)?;
    pending.commit()?;
    own::finish(path, &blake3::hash(bytes))
}

/// Writes a whole text file: all of it, or nothing. The hash of a text without a seal goes to the list of the folder of a run.
pub fn write_text(path: &Path, text: &str) -> Result<()> {
    let pending = Pending::new(path)?;
    fs::write(pending.path(), text).map_err(|e| Error::output(path, e))?;
    if seal::check_text(text.as_bytes()) != Seal::None {
        return pending.commit();
    }
    own::begin(path)?;
    pending.commit()?;
    own::finish(path, &blake3::hash(text.as_bytes()))
}
