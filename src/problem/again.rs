//! A scene that is run into a folder which may have a run of it already, `dgmpm run --resume`: it begins, goes on, or is done. A script
//! of a batch system can give the same command each time.

use super::Files;
use super::differences::difference;
use super::input::check_same_input;
use crate::error::{Error, Result};
use crate::io::{checkpoint, own};
use crate::run::Folder;
use crate::scene::Scene;

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
    /// A number by which ranks tell whether they have found the same.
    pub fn number(&self) -> f64 {
        match self {
            Self::Begins { .. } => 0.0,
            Self::GoesOn(_) => 1.0,
            Self::Done(_) => 2.0,
        }
    }

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
        let has_checkpoint = !checkpoint::list(&folder.checkpoints())?.is_empty();
        match folder.is_done() {
            true if old.end == new.end => Ok(Self::Done(format!("{root} has this run, done at {:.6e} s", old.end))),
            true if old.end > new.end => Ok(Self::Done(format!(
                "{root} has this run, done at {:.6e} s, which is later than the end {:.6e} s that is asked for: nothing is done, and its results are those \
                 of the later end",
                old.end, new.end
            ))),
            true if !has_checkpoint => {
                let what = format!("the run in {root} is done, and has no checkpoint to go on from to a later end");
                Err(new.error("time.end", what, "run the scene again with --force, with [checkpoint] in it"))
            }
            _ if has_checkpoint => Ok(Self::GoesOn(Box::new(new))),
            _ => Ok(Self::Begins { replaces: true }),
        }
    }
}
