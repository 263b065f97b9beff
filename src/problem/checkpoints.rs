//! The checkpoints of a run: when they are due, and how they are written into its folder.

use super::Body;
use crate::error::{Error, Result};
use crate::io::checkpoint::Checkpoint;
use crate::io::pending;
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::observe;
use crate::run::{Folder, Keep, Moment};
use crate::scene::{self, Scene};
use crate::state::State;
use crate::words::Words;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// The numbers that a run goes on from, by the name of what has saved them.
#[derive(Debug, Clone, Default)]
pub struct Resumed {
    /// See [`crate::run::keep`].
    pub parts: BTreeMap<String, Words>,
    /// The step, where outputs have seen its state.
    pub observed: Option<usize>,
}

impl Resumed {
    /// The numbers of a part.
    ///
    /// # Errors
    /// The checkpoint has none under this name.
    pub(super) fn part(&self, name: &str) -> Result<&Words> {
        self.parts.get(name).ok_or_else(|| {
            let what = format!("the checkpoint has nothing of `{name}`: it was saved by a run with other outputs");
            Error::input(what, "resume with the outputs of that run")
        })
    }
}

/// Keeps a run in its folder.
pub struct Checkpoints<'a> {
    folder: &'a Folder,
    /// The text of the scene in the folder; none on a rank that does not write.
    scene: Option<String>,
    every: Option<scene::Checkpoint>,
    /// Set from outside to keep the run and go on.
    save: &'a AtomicBool,
    last: Instant,
    /// The state that was kept last, by its step; none before.
    kept: Option<usize>,
    /// The step whose state outputs have seen already: that at which the run changed its grid.
    pub(super) observed: Option<usize>,
    /// The numbers of the motion to go on with.
    pub(super) motion: Option<Words>,
}

impl<'a> Checkpoints<'a> {
    /// For a run in a folder that has its scene; none in a folder without.
    pub fn new(scene: &Scene, folder: &'a Folder, save: &'a AtomicBool) -> Option<Self> {
        let text = std::fs::read_to_string(folder.scene()).ok()?;
        Some(Self { scene: Some(text), ..Self::silent(scene, folder, save) })
    }

    /// For a rank that knows when the run is kept, and leaves that to the first one.
    pub fn silent(scene: &Scene, folder: &'a Folder, save: &'a AtomicBool) -> Self {
        let (every, last) = (scene.checkpoint, Instant::now());
        Self { folder, scene: None, every, save, last, kept: None, observed: None, motion: None }
    }
}

/// [`Checkpoints`] on a grid of the run.
pub(super) struct OnGrid<'c, 'a> {
    pub checkpoints: &'c mut Checkpoints<'a>,
    pub body: &'c Body,
    pub files: &'c GridFiles,
}

impl Keep for OnGrid<'_, '_> {
    fn resumed(&mut self) -> Option<Words> {
        self.checkpoints.motion.take()
    }

    fn due(&mut self, state: &State, stops: bool) -> bool {
        let own = &mut *self.checkpoints;
        let asked = own.save.swap(false, Ordering::Relaxed);
        // The state that a run begins with is its input, and one that it goes on from is kept.
        let begins = *own.kept.get_or_insert(state.step);
        let timely = match own.every {
            None => false,
            Some(scene::Checkpoint::Steps(steps)) => state.step != begins && state.step.is_multiple_of(steps),
            Some(scene::Checkpoint::Minutes(minutes)) => {
                own.last.elapsed() >= Duration::from_secs_f64((60.0 * minutes).min(1e9))
            }
        };
        timely || asked || stops
    }

    fn at_end(&self) -> bool {
        self.checkpoints.every.is_some()
    }

    fn keep(&mut self, moment: &Moment) -> Result<()> {
        let own = &mut *self.checkpoints;
        (own.last, own.kept) = (Instant::now(), Some(moment.state.step));
        let Some(scene) = own.scene.clone() else { return Ok(()) };
        pending::check_folder(&own.folder.root)?;
        self.body.keep(own.folder, self.files)?;
        let checkpoint = Checkpoint {
            snapshot: Snapshot { grid: self.files.clone(), ..observe::without_cells(moment.scheme, moment.state) },
            scene,
            kernel: moment.scheme.kernel.name().to_owned(),
            observed: own.observed == Some(moment.state.step),
            has_snapshot: snapshot::path(&own.folder.snapshots(), moment.state.step).exists(),
            parts: moment.parts.iter().cloned().collect(),
        };
        let folder = own.folder.checkpoints();
        observe::with_cells(moment.scheme, moment.state, |made| checkpoint.write_with(&folder, Some(made))).map(drop)
    }
}
