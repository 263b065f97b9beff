//! `dgmpm plot`: maps and curves of a run, as pictures.

mod args;
mod format;

use super::print::{note, say};
use crate::error::{Error, Result};
use crate::file::check_place_of_folder;
use crate::format::count;
use crate::picture::{Maps, curves};
use crate::run::Folder;
use std::path::PathBuf;

pub use args::Args;

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    let folder = Folder::new(&args.run);
    let out = args.out.clone().unwrap_or_else(|| folder.plots());
    check_place_of_folder(&out)?;
    let ending = args.format.ending();
    let mut files: Vec<PathBuf> = Vec::new();
    match Maps::new(&folder, &args.field, args.when(), args.range()?) {
        Ok(maps) => {
            maps.far().into_iter().for_each(note);
            files.extend(maps.initial(args.initial).draw(&out, ending)?);
        }
        // A run without snapshots has curves, and may have been made for them.
        Err(why) if args.wants_maps() || !folder.scene().is_file() => return Err(why),
        Err(_) => note("the run has no snapshot, and so no map: add an [[output]] of kind = \"fields\""),
    }
    // Who names fields or times wants these.
    if !args.wants_maps() {
        files.extend(curves(&folder, &out, ending)?);
    }
    if files.is_empty() {
        let what = format!("{} has neither snapshots nor tables to draw", folder.root.display());
        return Err(Error::input(what, "run the scene to its end"));
    }
    files.iter().for_each(|path| say(format!("  {}", path.display())));
    say(format!("{} in {}", count(files.len(), "picture"), out.display()));
    Ok(())
}
