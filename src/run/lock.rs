//! The lock of a run on its folder: the list of its files, locked by the operating system, which lets go when the process ends,
//! however it ends.

use crate::error::Error;
use crate::file;
use crate::io::own::LIST;
use std::fs::{File, OpenOptions, TryLockError};
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

/// The folder of a run is taken as long as this lives.
#[derive(Debug)]
pub struct Lock {
    root: PathBuf,
    file: File,
}

impl Lock {
    /// Takes a folder, which is made where it is missing.
    ///
    /// # Errors
    /// Another run has it; a folder that cannot be made or written to.
    pub(super) fn take(root: &Path) -> Result<Self, Error> {
        let fail = |why: std::io::Error| Error::output(root, why);
        file::check_place_of_folder(root)?;
        std::fs::create_dir_all(root).map_err(fail)?;
        let list = root.join(LIST);
        let file = OpenOptions::new().create(true).append(true).open(&list);
        let file = file.map_err(|why| Error::output(&list, why))?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => {
                let what = format!("another run is writing into {}", root.display());
                return Err(Error::input(what, "wait for its end, or give another folder by --out"));
            }
            // A file system without locks: as before there were any.
            Err(TryLockError::Error(why)) if why.kind() == ErrorKind::Unsupported => {}
            Err(TryLockError::Error(why)) => return Err(Error::output(&list, why)),
        }
        Ok(Self { root: root.to_owned(), file })
    }
}

/// Whether a run is writing into a folder; looks, and writes nothing.
pub(super) fn is_taken(root: &Path) -> bool {
    let file = File::open(root.join(LIST));
    file.is_ok_and(|file| matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)))
}

impl Drop for Lock {
    fn drop(&mut self) {
        // Closing the file is not enough: a process that another thread is just starting shares it until its program begins.
        let _ = self.file.unlock();
        // A run that ended before it wrote anything leaves nothing; a folder with files stays.
        if self.file.metadata().is_ok_and(|about| about.len() == 0) {
            let _ = std::fs::remove_file(self.root.join(LIST));
            let _ = std::fs::remove_dir(&self.root);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_folder_is_taken_once_and_is_free_again_when_the_lock_is_dropped() {
        let folder = tempfile::tempdir().unwrap();
        let root = folder.path().join("run");
        let lock = Lock::take(&root).unwrap();
        assert!(Lock::take(&root).unwrap_err().to_string().contains("another run is writing into"));
        drop(lock);
        assert!(!root.exists(), "nothing was written");
        let lock = Lock::take(&root).unwrap();
        std::fs::write(root.join(LIST), "ledger.csv\n").unwrap();
        drop(lock);
        assert!(root.join(LIST).exists() && Lock::take(&root).is_ok());
    }

    #[test]
    fn a_process_that_shares_the_open_list_for_a_moment_does_not_keep_the_folder() {
        let folder = tempfile::tempdir().unwrap();
        let lock = Lock::take(folder.path()).unwrap();
        let shared = lock.file.try_clone().unwrap();
        drop(lock);
        assert!(Lock::take(folder.path()).is_ok());
        drop(shared);
    }
}
