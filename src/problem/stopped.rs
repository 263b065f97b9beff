//! A stopped run: its state at a step, brought to another mesh, in a folder that a run goes on from.

use super::Problem;
use super::input::foreign;
use crate::error::{Error, Result};
use crate::io::snapshot::{self, GridFiles, Snapshot};
use crate::io::{pending, seal};
use crate::mesh::Mesh;
use crate::observe;
use crate::regrid::points::Policy;
use crate::run::Folder;
use crate::scene::Scene;
use crate::step::Totals;
use std::path::{Path, PathBuf};

/// A stopped run at one of its snapshots.
pub struct Stopped<'a> {
    folder: &'a Folder,
    scene: Scene,
    snapshot: Snapshot,
}

impl<'a> Stopped<'a> {
    /// Reads scene and snapshot of a run; without a step the last snapshot.
    ///
    /// # Errors
    /// No run, or no snapshot of this step; files that cannot be read.
    pub fn read(folder: &'a Folder, step: Option<usize>) -> Result<Self> {
        let snapshot = Snapshot::read(&find(folder, step)?)?;
        Ok(Self { folder, scene: Scene::load(&folder.scene(), &[])?, snapshot })
    }

    /// Refuses a folder as the place of the result that is the one of the run itself, that has the file of the new `mesh` among what is
    /// removed, or that has files of the user under the names that are written; without `force` also one with results.
    ///
    /// # Errors
    /// One of these.
    pub fn check_target(&self, to: &Folder, mesh: &Path, force: bool) -> Result<()> {
        if !force {
            to.refuse_results()?;
        }
        let same =
            |a: &Path, b: &Path| a == b || a.canonicalize().ok().is_some_and(|a| b.canonicalize().ok() == Some(a));
        if same(&to.root, &self.folder.root) {
            return Err(Error::input("--out is the folder of the run itself", "give another folder"));
        }
        if to.takes(mesh) {
            let what = format!("{} lies in {}, where it is removed or replaced", mesh.display(), to.root.display());
            return Err(Error::input(what, "give another folder by --out"));
        }
        to.foreign().first().map_or(Ok(()), |name| Err(foreign(to, name)))
    }

    /// The problem on another mesh of the same body, and its totals before and after.
    ///
    /// # Errors
    /// A snapshot that does not belong to the run; a mesh that does not fit the body, or whose points cannot carry the degree.
    pub fn on(&self, mesh: Mesh, policy: Policy) -> Result<(Problem, [Totals; 2])> {
        let mut problem = Problem::of_snapshot(&self.scene, self.folder, &self.snapshot)?;
        let before = problem.scheme.totals(&problem.state);
        problem.regrid(mesh, policy)?;
        let after = problem.scheme.totals(&problem.state);
        Ok((problem, [before, after]))
    }
}

impl Problem {
    /// Writes scene, grid and state into a folder that `dgmpm run` goes on from; results of an earlier run in it are removed.
    ///
    /// # Errors
    /// Files that cannot be written.
    pub fn write_start(&self, folder: &Folder) -> Result<()> {
        let _lock = folder.lock()?;
        folder.clear_results()?;
        let files = GridFiles::default();
        self.body.write(folder, &files)?;
        self.scene.store_loads(folder)?;
        let path = observe::write(&self.scheme, &self.state, &files, &folder.snapshots())?;
        Snapshot::read(&path)?.write(&folder.root.join("initial.h5"))?;
        pending::write_text(&folder.scene(), &seal::text(&self.scene.portable_from("initial.h5"), seal::TOML))
    }
}

/// Energies and momentum before and after, as lines.
pub fn changes([before, after]: &[Totals; 2]) -> [String; 3] {
    let [a, b] = [before.momentum, after.momentum];
    [
        format!("kinetic energy {:.9e} -> {:.9e} J/m", before.kinetic, after.kinetic),
        format!("strain energy {:.9e} -> {:.9e} J/m", before.strain, after.strain),
        format!("momentum ({:.9e}, {:.9e}) -> ({:.9e}, {:.9e}) kg/s", a[0], a[1], b[0], b[1]),
    ]
}

/// The file of a step, or the last one.
fn find(from: &Folder, step: Option<usize>) -> Result<PathBuf> {
    let root = from.root.display();
    if !from.scene().is_file() {
        let what = format!("{root} is not the folder of a run: it holds no scene.toml");
        return Err(Error::input(what, "give the folder that `dgmpm run` has written, such as runs/square"));
    }
    let files = if from.snapshots().is_dir() { snapshot::list(&from.snapshots())? } else { vec![] };
    let found = match step {
        None => files.last(),
        Some(step) => files.iter().find(|(known, _)| *known == step),
    };
    let steps: Vec<String> = files.iter().map(|(step, _)| step.to_string()).collect();
    let remedy = match steps[..] {
        [] => "run a scene with an [[output]] of kind = \"fields\"".to_owned(),
        _ => format!("there are those of the steps {}", steps.join(", ")),
    };
    found.map(|(_, path)| path.clone()).ok_or_else(|| Error::input(format!("{root} holds no such snapshot"), remedy))
}
