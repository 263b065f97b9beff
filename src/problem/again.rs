//! A scene that is run into a folder which may have a run of it already, `dgmpm run --resume`: it begins, goes on, or is done. A script
//! of a batch system can give the same command each time.

use super::differences::difference;
use super::input::check_same_input;
use super::{Files, Newest};
use crate::error::{Error, Result};
use crate::io::{checkpoint, own};
use crate::run::Folder;
use crate::scene::Scene;
use serde_json::Value;

/// What is left to do of a scene in a folder.
pub enum Again {
    /// All of it: the folder has no run; or one of this scene that was stopped before its first checkpoint, whose results may go.
    Begins {
        /// Whether there are such results.
        replaces: bool,
    },
    /// What comes after the last checkpoint, with this scene.
    GoesOn(Box<Scene>),
    /// Nothing, in words.
    Done(String),
}

impl Again {
    /// Looks into a folder; changes nothing.
    ///
    /// # Errors
    /// A run of another scene, mesh or points there, with what differs; files that cannot be read.
    pub fn look(scene: &Scene, folder: &Folder) -> Result<Self> {
        if !folder.scene().is_file() || own::is_foreign(&folder.scene()) {
            return Ok(Self::Begins { replaces: false });
        }
        let old = Scene::load(&folder.scene(), &[])?;
        let text = scene.portable_toml(false, false);
        let new = Scene::parse(&text, &folder.scene(), &[])?;
        let root = folder.root.display();
        if let Some(what) = difference(&old, &new) {
            let remedy = "give another folder by --out, or the scene of that run; title, time.end, [watch] and [checkpoint] may change";
            return Err(Error::input(format!("{root} has a run of another scene: {what}"), remedy));
        }
        check_same_input(scene, &Files::default().body(scene)?, folder)?;
        let end = match checkpoint::list(&folder.checkpoints())?.is_empty() {
            true => Self::end_of_done(folder),
            false => Some(Newest::read(folder)?.at().0),
        };
        match end {
            Some(end) if end >= scene.end => Ok(Self::Done(format!("{root} has this run, done at {end:.6e} s"))),
            Some(_) if checkpoint::list(&folder.checkpoints())?.is_empty() => {
                let what = format!("the run in {root} is done, and has no checkpoint to go on from to a later end");
                Err(new.error("time.end", what, "run the scene again with --force, with [checkpoint] in it"))
            }
            Some(_) => Ok(Self::GoesOn(Box::new(new))),
            None => Ok(Self::Begins { replaces: true }),
        }
    }

    /// The time at which a run without checkpoints came to its end, by its summary, s.
    fn end_of_done(folder: &Folder) -> Option<f64> {
        let text = std::fs::read_to_string(folder.summary()).ok()?;
        let summary: Value = serde_json::from_str(&text).ok()?;
        (summary["status"] == "done").then(|| summary["end_time"].as_f64()).flatten()
    }
}
