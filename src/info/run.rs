//! The folder of a run or of a study, and the summary of a run.

use super::{Info, READ, scene};
use crate::error::{Error, Place, Result};
use crate::io::{checkpoint, snapshot};
use crate::run::Folder;
use serde_json::{Map, Value};
use std::path::Path;

/// What a folder holds.
///
/// # Errors
/// A folder that is neither of a run nor of a study.
pub(super) fn folder(path: &Path) -> Result<Info> {
    let folder = Folder::new(path);
    if folder.scene().is_file() {
        return of_run(&folder);
    }
    if path.join("study.csv").is_file() {
        return Ok(Info::new("folder of a study").with("files", names(path)));
    }
    Err(Error::at(Place::file(path), "this is not the folder of a run or of a study", READ))
}

fn of_run(folder: &Folder) -> Result<Info> {
    let of_scene = scene::info(&folder.scene())?;
    let text = std::fs::read_to_string(folder.summary()).unwrap_or_default();
    let known: Value = serde_json::from_str(&text).unwrap_or(Value::Null);
    let status = match known["status"].as_str() {
        Some(status) => status,
        None if folder.is_taken() => "running",
        None => "killed, or not begun: there is no summary.json",
    };
    let mut info = Info::new("folder of a run").with("status", status);
    info.facts.extend(of_scene.facts);
    let in_folder = |name: &str| names(&folder.root.join(name));
    let snapshots = if folder.snapshots().is_dir() { snapshot::list(&folder.snapshots())? } else { vec![] };
    let steps = |all: Vec<(usize, std::path::PathBuf)>| all.into_iter().map(|(step, _)| step).collect::<Vec<_>>();
    let info = info
        .with("steps_with_snapshot", steps(snapshots))
        .with("steps_with_checkpoint", steps(checkpoint::list(&folder.checkpoints())?))
        .with("tracks", in_folder("tracks"))
        .with("lines", in_folder("lines"))
        .with("exported_files", in_folder("export").len())
        .with("plots", in_folder("plots"));
    Ok(figures(info, &known))
}

/// What a summary says; none where the text is no summary.
pub(super) fn summary(text: &str) -> Option<Info> {
    let known: Value = serde_json::from_str(text).ok()?;
    let status = known["status"].as_str()?;
    Some(figures(Info::new("summary of a run").with("status", status), &known))
}

/// The figures of a summary that are one value each, its quantities, and where the run comes from.
fn figures(info: Info, known: &Value) -> Info {
    let plain = |value: &Value| value.is_number() || value.is_string();
    let all = known.as_object().into_iter().flatten();
    let single = all.filter(|(name, value)| plain(value) && !["status", "title"].contains(&&name[..]));
    let info = single.fold(info, |info, (name, value)| info.with(name, value.clone()));
    let parts = |name: &str| -> Map<String, Value> { known[name].as_object().cloned().unwrap_or_default() };
    ["quantities", "provenance"].into_iter().fold(info, |info, name| match parts(name) {
        parts if parts.is_empty() => info,
        parts => info.with(name, parts),
    })
}

/// The names of the files in a folder, sorted.
fn names(folder: &Path) -> Vec<String> {
    let all = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut names: Vec<String> = all.filter_map(|entry| entry.file_name().into_string().ok()).collect();
    names.sort();
    names
}
