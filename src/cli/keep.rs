//! Files that are not written over.

use crate::error::{Error, Result};
use crate::file::check_place_of_folder;
use std::path::{Path, PathBuf};

/// Refuses to write over a file unless `force`.
pub fn keep(path: &Path, force: bool) -> Result<()> {
    keep_as(path, force, "another --out")
}

/// The same, where the file is not named by --out but as `other` says.
pub fn keep_as(path: &Path, force: bool, other: &str) -> Result<()> {
    path.parent().map_or(Ok(()), check_place_of_folder)?;
    if path.exists() && !force {
        let remedy = format!("give --force to replace it, or {other}");
        return Err(Error::input(format!("{} exists", path.display()), remedy));
    }
    Ok(())
}

/// The same, where a command reads the files `inputs`: none of them is written over, whatever is given.
pub fn keep_from(path: &Path, force: bool, inputs: &[PathBuf]) -> Result<()> {
    let whole = |path: &Path| path.canonicalize().ok();
    if whole(path).is_some_and(|own| inputs.iter().any(|input| whole(input).as_ref() == Some(&own))) {
        return Err(Error::input(format!("{} is read by this command", path.display()), "give another --out"));
    }
    keep(path, force)
}
