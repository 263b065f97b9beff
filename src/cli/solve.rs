//! `dgmpm solve`: steps the conservation laws.

use super::pipeline::{self, Body, Files};
use super::print::say;
use super::progress::Progress;
use super::{RunArgs, SceneArgs, preprocess, summary};
use crate::error::{Error, Result};
use crate::mesh::map;
use crate::observe;
use crate::run::{Folder, Report, Run, Settings, Stop};
use crate::scene::Scene;
use crate::state::State;
use crate::step::{Loss, Scheme};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};

/// Set by the first Ctrl-C.
static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// Arguments.
#[derive(Debug, clap::Args)]
pub struct Args {
    #[command(flatten)]
    scene: SceneArgs,
    #[command(flatten)]
    files: Files,
    /// Stored matrices of `preprocess`
    #[arg(long, value_name = "FILE")]
    operators: Option<PathBuf>,
    #[command(flatten)]
    run: RunArgs,
}

/// Runs it.
pub fn run(args: &Args) -> Result<()> {
    all(&args.scene, &args.files, args.operators.as_deref(), &args.run)
}

/// The whole pipeline into a run folder; `operators` is used if it was built from the same input.
pub fn all(scene_args: &SceneArgs, files: &Files, operators: Option<&Path>, run: &RunArgs) -> Result<()> {
    run.start_threads()?;
    let scene = Scene::load(&scene_args.scene, &scene_args.sets)?;
    let folder = run.folder(&scene);
    let body = files.body(&scene)?;
    let path = operators.map_or_else(|| folder.operators(), Path::to_owned);
    let (operators, reused) = pipeline::operators(&scene, &body, Some(&path))?;
    let scheme = pipeline::scheme(&scene, &body, operators);
    let settings = scene.settings(&scheme.method)?;
    let state = scene.initial_state(&body.mesh, &scheme)?;
    folder.clear_results(run.force)?;
    pipeline::write_input(&scene, &scene_args.sets, &body, &folder)?;
    say(&scene.title);
    preprocess::report(&scene, &body, &scheme, &state, settings)?;
    if reused {
        say(format!("matrices reused from {}", path.display()));
    }
    Solve { scene: &scene, body: &body, scheme: &scheme, folder: &folder }.run(state, settings)
}

struct Solve<'a> {
    scene: &'a Scene,
    body: &'a Body,
    scheme: &'a Scheme,
    folder: &'a Folder,
}

impl Solve<'_> {
    fn run(&self, mut state: State, settings: Settings) -> Result<()> {
        // A second handler (in a test that runs twice in one process) is no reason to stop.
        let _ = ctrlc::set_handler(|| INTERRUPT.store(true, Ordering::Relaxed));
        let mut observers = self.scene.observers(&self.body.mesh, self.folder)?;
        observers.push(Box::new(Progress::new(settings.end)));
        let mut run = Run { mesh: &self.body.mesh, scheme: self.scheme, settings, observers, interrupt: &INTERRUPT };
        let mut report = Report::default();
        let outcome = run.advance(&mut state, &mut report);
        drop(run);
        report.finish(self.scheme, &state);
        let (status, result) = match outcome {
            Ok(()) => ("done", Ok(())),
            Err(stop) => self.stopped(stop, &state),
        };
        summary::print(self.scheme, &report);
        summary::write(self.scene, self.body, self.scheme, &state, &report, self.folder, status)?;
        say(format!("results in {}", self.folder.root.display()));
        result
    }

    /// Keeps the last good state and says why the run ended.
    fn stopped(&self, stop: Stop, state: &State) -> (&'static str, Result<()>) {
        if let Stop::Output(error) = stop {
            return ("failed", Err(error));
        }
        let kept = observe::write(self.scheme, state, &self.folder.snapshots());
        let place = match &kept {
            Ok(path) => format!("the last good state is in {}", path.display()),
            Err(why) => format!("the last good state could not be kept: {why}"),
        };
        match stop {
            Stop::Unstable(loss) => ("unstable", Err(self.unstable(&loss, state, &place))),
            _ => (
                "interrupted",
                Err(Error::Interrupted(format!("at step {}, t = {:.6e} s; {place}", state.step, state.time))),
            ),
        }
    }

    fn unstable(&self, loss: &Loss, state: &State, place: &str) -> Error {
        let x = match &self.scheme.operators.points {
            Some(points) => {
                let (block, lane) = self.scheme.operators.blocks.slot[loss.cell];
                [0, 1].map(|k| points.parent[2 * (points.first[block] + loss.point) + k].0[lane])
            }
            None => self.scheme.operators.line.basis.node_2d(loss.point),
        };
        let x = map::position(&self.body.mesh.corners(loss.cell), x);
        let number = self.body.mesh.number(loss.cell);
        Error::Unstable {
            what: format!("{} in cell {number}, point {}, at X = ({:.6}, {:.6})", loss.kind, loss.point, x[0], x[1]),
            time: state.time,
            step: state.step + 1,
            remedy: format!("{place}; a smaller scheme.safety, a finer mesh, or [curl] control = \"lcf\" may help"),
        }
    }
}
