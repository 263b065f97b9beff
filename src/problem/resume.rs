//! A run that goes on from its last checkpoint.

use super::differences::difference;
use super::{Body, Problem, Resumed, Setup};
use crate::error::{Error, Result};
use crate::exchange::Exchange;
use crate::io::checkpoint::{self, Checkpoint};
use crate::io::fingerprint::Fingerprint;
use crate::io::{pending, seal};
use crate::lane::Kernel;
use crate::run::Folder;
use crate::scene::Scene;
use std::path::PathBuf;
use std::sync::Arc;

/// The newest checkpoint of a run that is whole.
pub struct Newest {
    checkpoint: Checkpoint,
    /// Its file.
    pub path: PathBuf,
    /// Newer ones that are damaged, in words.
    pub damaged: Vec<String>,
}

impl Newest {
    /// Reads the newest checkpoint of a folder; where it is damaged, the one before.
    ///
    /// # Errors
    /// A folder without a run, or without a whole checkpoint.
    pub fn read(folder: &Folder) -> Result<Self> {
        let root = folder.root.display();
        if !folder.scene().is_file() {
            let what = format!("{root} is not the folder of a run: it holds no scene.toml");
            return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
        }
        let mut damaged = Vec::new();
        for (_, path) in checkpoint::list(&folder.checkpoints())?.into_iter().rev() {
            match Checkpoint::read(&path) {
                Ok(checkpoint) => return Ok(Self { checkpoint, path, damaged }),
                Err(why) => damaged.push(why.to_string()),
            }
        }
        let what = match damaged.first() {
            Some(why) => format!("{root} holds no whole checkpoint: {why}"),
            None => format!("{root} holds no checkpoint"),
        };
        let remedy =
            "run the scene again with --force, with [checkpoint] in it; `[initial] snapshot` begins from a snapshot";
        Err(Error::input(what, remedy))
    }

    /// Time of its state, s, and its step.
    pub fn at(&self) -> (f64, usize) {
        (self.checkpoint.snapshot.time, self.checkpoint.snapshot.step)
    }

    /// The problem at the checkpoint, with overrides `key.path=value` of its scene, and on the same instruction set. What the run wrote
    /// after the checkpoint is removed from its folder, and written again by the run.
    ///
    /// # Errors
    /// A scene in which a key differs that may not; files of the folder that are not those of the run; a run that is at its end.
    pub fn problem(self, folder: &Folder, sets: &[String], kernel: Option<Kernel>) -> Result<Problem> {
        let scene = Scene::load(&folder.scene(), sets)?;
        let (problem, later) = self.open(folder, scene, kernel, None)?;
        later.remove(folder, &problem.scene)?;
        Ok(problem)
    }

    /// The same with a scene, whose files are those of the folder, for one of several ranks; and what the run wrote after the
    /// checkpoint, which is still there.
    ///
    /// # Errors
    /// As for [`Newest::problem`].
    pub fn open(
        self,
        folder: &Folder,
        scene: Scene,
        kernel: Option<Kernel>,
        exchange: Option<Arc<dyn Exchange>>,
    ) -> Result<(Problem, Later)> {
        let Checkpoint { snapshot, scene: text, kernel: name, observed, has_snapshot, parts } = self.checkpoint;
        let old = Scene::parse(&text, &folder.scene(), &[])?;
        if let Some(what) = difference(&old, &scene) {
            let remedy = "only title, time.end, [watch] and [checkpoint] may change; for another scene use `dgmpm run`";
            return Err(Error::input(format!("the checkpoint is of another scene: {what}"), remedy));
        }
        // A run that was killed at its end has its last rows still before it.
        let remedy = "give a later end by --set time.end=..";
        if snapshot.time > scene.end {
            let (time, step, end) = (snapshot.time, snapshot.step, scene.end);
            let what = format!(
                "the run has got to {time:e} s already (step {step}), beyond the end {end:e} s that is asked for"
            );
            return Err(scene.error("time.end", what, remedy));
        }
        if snapshot.time == scene.end && folder.is_done() {
            return Err(scene.error("time.end", format!("the run is at its end, {:e} s", snapshot.time), remedy));
        }
        let kernel = kernel_of(&name, kernel)?;
        let body = Body::read(&scene, folder, &snapshot.grid)?;
        let problem = Setup { exchange, ..Setup::of(&scene).kernel(kernel) }.build_from(body, |_, scheme| {
            if let Some((what, _)) = snapshot.made_on.misfit(&Fingerprint::of(scheme)) {
                let what = format!(
                    "mesh, points or materials in {} are not those of the checkpoint: {what}",
                    folder.root.display()
                );
                return Err(Error::input(what, "put the files of the run back, or run the scene again with --force"));
            }
            scene.state_of(&snapshot, scheme)
        })?;
        let observed_at = observed.then_some(snapshot.step);
        let later = Later { step: snapshot.step, with_snapshot: observed && has_snapshot };
        let resumed = Some(Resumed { parts, observed: observed_at });
        Ok((Problem { files: snapshot.grid, resumed, ..problem }, later))
    }
}

/// What a run wrote after its checkpoint.
pub struct Later {
    step: usize,
    /// Whether the snapshot of the step itself stays.
    with_snapshot: bool,
}

impl Later {
    /// Removes it from the folder, and puts the scene that the run goes on with there.
    ///
    /// # Errors
    /// A file that cannot be removed or written.
    pub fn remove(self, folder: &Folder, scene: &Scene) -> Result<()> {
        folder.cut_back(self.step, self.with_snapshot)?;
        let wanted = seal::text(&scene.to_toml(), seal::TOML);
        if std::fs::read_to_string(folder.scene()).is_ok_and(|there| there != wanted) {
            pending::write_text(&folder.scene(), &wanted)?;
        }
        Ok(())
    }
}

/// The instruction set of a checkpoint, which another one may not take the place of: the last digits differ.
fn kernel_of(name: &str, asked: Option<Kernel>) -> Result<Kernel> {
    let known = Kernel::NAMES.iter().find(|(known, _)| *known == name).map(|(_, kernel)| *kernel);
    let remedy = "resume on a processor that has it, or run the scene again with --force and --kernel";
    match known.filter(|kernel| kernel.is_available()) {
        None => Err(Error::input(format!("the run was stepped by {name}, which this processor lacks"), remedy)),
        Some(kernel) if asked.is_some_and(|asked| asked != kernel) => {
            let what = format!("the run was stepped by {name}: another --kernel would change its last digits");
            Err(Error::input(what, "leave out --kernel"))
        }
        Some(kernel) => Ok(kernel),
    }
}
