//! Mesh files, and where the files of a rule go in the folder of a run.

use super::{Present, Rule, Values, same};
use crate::error::{Error, Place, Result};
use crate::io::pending::{Pending, write_text};
use crate::io::{mesh_file, read_mesh, regular, seal};
use crate::mesh::Mesh;
use std::path::Path;

/// What becomes of the files that a rule names, so that the folder of a run can be moved and run again.
#[derive(Clone, Copy)]
pub struct Stored {
    /// The name of the k-th file of a rule, by the numbers of both.
    pub name: fn(usize, usize) -> String,
    /// Writes it there.
    pub store: fn(&Path, &Path) -> Result<()>,
}

/// Meshes, in the format of the program.
pub const MESHES: Stored = Stored {
    name: |rule, k| format!("regrid_{rule}_{k}.h5"),
    store: |from, to| mesh_file::write_mesh(to, &read_mesh(from)?),
};

/// A geometry, copied.
pub const GEOMETRY: Stored =
    Stored { name: |rule, _| format!("regrid_{rule}.geo"), store: |from, to| copy_text(from, to, seal::GEO) };

/// Whether two paths are one file.
fn is_same(from: &Path, to: &Path) -> bool {
    from.canonicalize().ok().is_some_and(|from| to.canonicalize().is_ok_and(|to| to == from))
}

/// Copies a regular file, unless it is there already. It appears whole, and takes the place of a link of its name.
///
/// # Errors
/// A file that cannot be read or written.
pub fn copy(from: &Path, to: &Path) -> Result<()> {
    if is_same(from, to) {
        return Ok(());
    }
    regular::about(from).map_err(|why| Error::at(Place::file(from), why, "give a file"))?;
    let pending = Pending::new(to)?;
    std::fs::copy(from, pending.path()).map_err(|why| Error::output(to, why))?;
    pending.commit()
}

/// Copies a text file, unless it is there already, with a seal as a comment in its last line.
///
/// # Errors
/// A file that is no text, or cannot be written.
pub fn copy_text(from: &Path, to: &Path, comment: [&str; 2]) -> Result<()> {
    if is_same(from, to) {
        return Ok(());
    }
    let text =
        regular::text(from, LARGEST_TEXT).map_err(|why| Error::at(Place::file(from), why, "give a text file"))?;
    write_text(to, &seal::text(&text, comment))
}

/// Bytes of the largest text that is copied.
const LARGEST_TEXT: u64 = 1 << 30;

pub(super) fn make(of: &Values, rule: &dyn Rule, count: usize, _: &Present) -> Result<Mesh> {
    let files = of.texts("mesh");
    read_mesh(&rule.resolve(&files[count % files.len()]))
}

pub(super) fn check(of: &Values, rule: &dyn Rule, first: &Mesh) -> Result<()> {
    for file in of.texts("mesh") {
        let path = rule.resolve(file);
        if !path.exists() {
            let what = format!("there is no file {}", path.display());
            return Err(rule.wrong("mesh", what, "give the path of a file, relative to the scene file"));
        }
        let mesh = read_mesh(&path)?;
        let here = |why: Error| {
            rule.wrong("mesh", format!("{file}: {why}"), "give meshes of the same body with the same groups")
        };
        rule.accepts(&mesh).map_err(here)?;
        if let Some(what) = same::difference(&mesh, first) {
            let remedy = "give meshes of the same body in its initial configuration";
            return Err(rule.wrong("mesh", format!("{file} is of another body: {what}"), remedy));
        }
    }
    Ok(())
}
