//! `checkpoints/000123.h5`: all that a run needs to go on as if it had never stopped. The last two are kept.
//!
//! The arrays are those of a snapshot, and `part_<name>` with the numbers of whatever lives on beside the state
//! ([`crate::words::Words`]): survey, report, rules of regrids, observers. The text of the scene is such a part.
//! Attributes: those of a snapshot; `kernel`, the instruction set; `observed`, whether outputs have seen
//! the state; `has_snapshot`, whether there was a snapshot of it; `threads`, their number, which changes no result. A checkpoint has a seal, or is refused.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use super::hdf5::Kept;
use super::pending::check_folder;
use super::seal::{self, Seal};
use super::snapshot::{self, OfCells, Snapshot};
use super::store::{ArrayRef, Format, Store};
use crate::error::{Error, Place, Result};
use crate::words::Words;

/// The format of checkpoints.
pub const FORMAT: Format = Format { name: "dgmpm checkpoint", version: 1, remedy: REMEDY };
const REMEDY: &str = "resume from an older checkpoint, or run the scene again with --force";
/// Before the name of a part.
const PART: &str = "part_";
/// The part of the scene.
const SCENE: &str = "scene";
const YES: &str = "yes";
/// How many are kept.
const KEPT: usize = 2;

/// A run between two steps.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Checkpoint {
    /// The state.
    pub snapshot: Snapshot,
    /// The text of its scene.
    pub scene: String,
    /// The instruction set that it was stepped by.
    pub kernel: String,
    /// Whether outputs have seen the state: the run has changed its grid since.
    pub observed: bool,
    /// Whether there was a snapshot of it already.
    pub has_snapshot: bool,
    /// The numbers of what lives on, by its name.
    pub parts: BTreeMap<String, Words>,
}

impl Checkpoint {
    /// Writes it into a folder, and removes all but the last ones there. It appears whole and on the disk, or not at all.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, folder: &Path) -> Result<PathBuf> {
        self.write_with(folder, None)
    }

    /// The same with numbers of the cells that are made while they are written.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write_with(&self, folder: &Path, made: Option<&OfCells>) -> Result<PathBuf> {
        let path = snapshot::path(folder, self.snapshot.step);
        let word = |is: bool| if is { YES } else { "no" }.to_owned();
        let attributes = vec![
            ("kernel", self.kernel.clone()),
            ("observed", word(self.observed)),
            ("has_snapshot", word(self.has_snapshot)),
            ("threads", rayon::current_num_threads().to_string()),
        ];
        let mut scene = Words::default();
        scene.text(&self.scene);
        let all = self.parts.iter().map(|(name, words)| (&name[..], words)).chain([(SCENE, &scene)]);
        let names: Vec<(String, &Words)> = all.map(|(name, words)| (format!("{PART}{name}"), words)).collect();
        let arrays = names.iter().map(|(name, words)| (&name[..], vec![words.0.len()], ArrayRef::U64(&words.0)));
        self.snapshot.write_as(&path, made, (FORMAT, Kept::OnDisk), attributes, arrays.collect())?;
        // A folder that went away in the meantime is the reason of whatever failed.
        remove_older(folder, &path).or_else(|why| check_folder(folder).and(Err(why)))?;
        Ok(path)
    }

    /// Reads one.
    ///
    /// # Errors
    /// A file that is damaged or is no checkpoint.
    pub fn read(path: &Path) -> Result<Self> {
        let fail = |what: &str| Error::at(Place::file(path), what, REMEDY);
        if seal::check(path).map_err(|why| fail(&format!("cannot be read: {why}")))? != Seal::Whole {
            return Err(fail("the file is damaged: its bytes are not those that were written"));
        }
        let mut store = Store::read(path, FORMAT)?;
        let kernel = store.attribute("kernel")?.to_owned();
        let [observed, has_snapshot] =
            ["observed", "has_snapshot"].map(|name| store.attribute(name).map(|is| is == YES));
        let names: Vec<String> = store.names().filter_map(|name| name.strip_prefix(PART)).map(str::to_owned).collect();
        let mut parts = BTreeMap::new();
        for name in names {
            let words = Words(store.unsigned(&format!("{PART}{name}"), &[])?);
            parts.insert(name, words);
        }
        let snapshot = Snapshot::take(&mut store)?;
        let scene = parts.remove(SCENE).unwrap_or_default().saved().text()?;
        Ok(Self { snapshot, scene, kernel, observed: observed?, has_snapshot: has_snapshot?, parts })
    }
}

/// Removes all checkpoints but the last ones, of which `path` is the newest.
fn remove_older(folder: &Path, path: &Path) -> Result<()> {
    let mut all = list(folder)?;
    all.retain(|(_, other)| other != path);
    for (_, old) in &all[..all.len().saturating_sub(KEPT - 1)] {
        std::fs::remove_file(old).map_err(|why| Error::output(old, why))?;
    }
    Ok(())
}

/// Those of the names of a run's files that are the checkpoints which it keeps: the last ones.
pub fn kept<'a>(names: impl Iterator<Item = &'a str>) -> Vec<String> {
    let step = |name: &str| name.strip_prefix("checkpoints/")?.strip_suffix(".h5")?.parse::<usize>().ok();
    let mut all: Vec<(usize, &str)> = names.filter_map(|name| Some((step(name)?, name))).collect();
    all.sort_unstable();
    all.iter().rev().take(KEPT).map(|(_, name)| (*name).to_owned()).collect()
}

/// The checkpoints of a folder, as (step, file), in the order of steps; none where it is not there.
///
/// # Errors
/// A folder that cannot be listed.
pub fn list(folder: &Path) -> Result<Vec<(usize, PathBuf)>> {
    if folder.is_dir() { snapshot::list(folder) } else { Ok(vec![]) }
}
